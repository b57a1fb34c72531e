"""`.if_then_else`, `.loop`, `.foreach`, `.fork`: as steps of a plan they are statements (see `plans.written_out`)."""

from bdi.builtin.kinds import ANY, FORMULA, Kind, optional, rest
from bdi.builtin.table import Answer, internal_action
from bdi.language.terms import atom
from bdi.model.intentions import StepFailed
from bdi.model.mind import Mind

STATEMENTS = {
    "if_then_else": (FORMULA, ANY, optional(ANY)),
    "loop": (FORMULA, ANY),
    "foreach": (FORMULA, ANY),
    "fork": (Kind("the word and, or the word or", lambda value: value in (atom("and"), atom("or"))), ANY, rest(ANY)),
}


def _register(name: str) -> None:
    def elsewhere(mind: Mind, *args: object) -> Answer:
        raise StepFailed("wrong_arguments", f".{name} is a step of a plan, not a condition or a value")

    internal_action(name, *STATEMENTS[name])(elsewhere)


for _name in STATEMENTS:
    _register(_name)
