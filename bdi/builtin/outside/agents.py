"""Other agents, and the directory of services: `.create_agent`, `.kill_agent`, `.df_search`, …"""

from bdi.builtin.arguments import bind, items_of, running_intention, text_of
from bdi.builtin.kinds import ANY, ATOM, LIST, LITERAL, OUT, TIME_SPAN, WHOLE, kind, optional
from bdi.builtin.table import Answer, internal_action, wrong_arguments
from bdi.language.errors import AgentSpeakSyntaxError, NotALiteral
from bdi.language.parser import literal_from, parse_term
from bdi.language.syntax import Trigger
from bdi.language.terms import Atom, List, Literal, String, Structure, Term, Var, atom
from bdi.model.messages import Message
from bdi.model.mind import Mind

NAME = kind("a name", Atom, String)
NAME_OR_VARIABLE = kind("a name or a variable", Atom, String, Var)
ANY_KIND = String("")  # of a service
NO_OPTIONS = List()
NO_FILE = String("")  # of an agent without a program
UNNAMED = "agent"


@internal_action("all_names", OUT)
def all_names(mind: Mind, names: Term) -> Answer:
    return bind(mind, names, List(map(atom, mind.society.names())))


@internal_action("create_agent", NAME_OR_VARIABLE, optional(NAME), optional(LIST), optional(OUT))
def create_agent(
    mind: Mind, name: Term, source: Term = NO_FILE, options: Term = NO_OPTIONS, result: Term | None = None
) -> Answer:
    """.create_agent(NAME, "file.asl", [beliefs([b(1)]), goals([g])], REAL_NAME): runs from the next round on.

    Without a file it has no program, until others tell it how. A NAME without value gets that of the file. If the name
    is taken, the agent is called NAME_2, NAME_3, …
    """
    file = text_of(source)
    wanted = _name_of(file) if isinstance(name, Var) else text_of(name)
    given = _options(options)
    real = atom(mind.society.create(wanted, file, given.get("beliefs", ()), given.get("goals", ())))
    return (not isinstance(name, Var) or bind(mind, name, real)) and (result is None or bind(mind, result, real))


def _name_of(file: str) -> str:
    return file.rpartition("/")[2].removesuffix(".asl") or UNNAMED


def _options(options: Term) -> dict[str, list[Literal]]:
    given: dict[str, list[Literal]] = {}
    for option in items_of(options, "create_agent"):
        if not isinstance(option, Structure) or option.functor not in ("beliefs", "goals") or len(option.args) != 1:
            raise wrong_arguments("create_agent", "options beliefs([…]) and goals([…])", option)
        given[option.functor] = _literals(option.args[0])
    return given


def _literals(term: Term) -> list[Literal]:
    """[b(1),b(2)]   "b(1), b(2)"   b(1)"""
    try:
        listed = parse_term(f"[{text_of(term)}]") if isinstance(term, String) else term
        return [literal_from(each) for each in (listed if isinstance(listed, List) else (listed,))]
    except (AgentSpeakSyntaxError, NotALiteral) as error:
        raise wrong_arguments("create_agent", "literals, as a list or as text", term) from error


@internal_action("clone", NAME_OR_VARIABLE, optional(OUT))
def clone(mind: Mind, name: Term, result: Term | None = None) -> Answer:
    """Another agent that believes and can do what this one does, with no goals."""
    wanted = mind.name if isinstance(name, Var) else text_of(name)
    real = atom(mind.society.clone(mind.name, wanted))
    return (not isinstance(name, Var) or bind(mind, name, real)) and (result is None or bind(mind, result, real))


@internal_action("kill_agent", NAME)
def kill_agent(mind: Mind, name: Term) -> Answer:
    """Fails if there is no such agent."""
    return mind.society.kill(text_of(name))


@internal_action("stopMAS", optional(TIME_SPAN), optional(WHOLE))
def stop(mind: Mind, after_ms: float = 0, exit_code: int = 0) -> Answer:
    """.stopMAS(MS, EXIT_CODE): all agents stop, after so many milliseconds."""
    mind.society.stop(mind.now + after_ms / 1000, exit_code)
    return True


@internal_action("save_agent", NAME, optional(ANY))
def save_agent(mind: Mind, target: Term, goals: Term | None = None) -> Answer:
    """.save_agent("file.asl", [goal]): beliefs, rules and plans of this agent as a program."""
    mind.society.save(text_of(target), mind.name, _literals(goals) if goals is not None else ())
    return True


# ---- the directory facilitator -------------------------------------------------------------------------------------


@internal_action("df_register", NAME, optional(NAME))
def df_register(mind: Mind, service: Term, kind: Term = ANY_KIND) -> Answer:
    mind.society.register(mind.name, text_of(service), text_of(kind))
    return True


@internal_action("df_deregister", NAME, optional(NAME))
def df_deregister(mind: Mind, service: Term, kind: Term = ANY_KIND) -> Answer:
    mind.society.deregister(mind.name, text_of(service), text_of(kind))
    return True


@internal_action("df_search", NAME, ANY, optional(OUT))
def df_search(mind: Mind, service: Term, *more: Term) -> Answer:
    """.df_search(SERVICE, AGENTS)   .df_search(SERVICE, KIND, AGENTS)"""
    *kind, agents = more
    found = mind.society.search(text_of(service), text_of(kind[0]) if kind else "")
    return bind(mind, agents, List(map(atom, found)))


@internal_action("df_subscribe", NAME, optional(NAME))
def df_subscribe(mind: Mind, service: Term, kind: Term = ANY_KIND) -> Answer:
    """Subscribe: from now on `provider(AGENT,SERVICE)[source(df)]` is believed of every agent that offers it."""
    mind.society.subscribe(mind.name, text_of(service), text_of(kind))
    return True


# ---- what plans for messages are made of ---------------------------------------------------------------------------


@internal_action("kqml.default", NAME, ATOM, ANY, NAME)
def kqml_default(mind: Mind, sender: Term, performative: Term, content: Term, message_id: Term) -> Answer:
    """Process the message as if the program had no plan `+!kqml_received(SENDER, PERFORMATIVE, CONTENT, ID)`."""
    mind.message_handling.obey(Message(text_of(sender), text_of(performative), content, mind.name, text_of(message_id)))
    return True


@internal_action("kqml.test", LITERAL)
def kqml_test(mind: Mind, question: Literal) -> Answer:
    """?question, by plans alone."""
    options = mind.library.options(Trigger.TEST_ADDED, question.predicate)
    mind.actions.ask_plans(running_intention(mind, "kqml.test"), question, options)
    return True
