"""Messages of other agents: read at the door, obeyed one a cycle; and the questions whose answers are waited for."""

from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from bdi.language.errors import BdiError, NotALiteral, UnknownPerformative
from bdi.language.parser import literal_from, parse_plan, term_from
from bdi.language.syntax import GOAL_ADDED, Trigger
from bdi.language.terms import FALSE, Atom, List, Literal, String, Structure, Term, Var, atom, predicate, show
from bdi.language.unify import is_ground, undo, unify
from bdi.model.intentions import Intention, State, StepFailed
from bdi.model.messages import WAITED_FOR, Message
from bdi.model.plans import CompiledPlan, Options, relevant
from bdi.model.society import Asked, Reader
from bdi.model.waiting import reason_of
from bdi.reasoning.actions import Doing
from bdi.reasoning.outcome import GoalFailure
from bdi.reasoning.percepts import REMEMBERED_TEXTS
from bdi.reasoning.performatives import KNOW_HOW, PERFORMATIVES, Performative, with_nested_source

KQML_RECEIVED = predicate("kqml_received", 4)
DEFAULT_PLAN = "@kqml_default +!kqml_received(S,P,C,M) <- .kqml.default(S,P,C,M)."
ANSWERING_PLANS = (  # for questions that no belief answers, but a plan `+?p(X)`
    "@kqml_answer +!kqml::answer(S,C,M) <- .kqml.test(C); .send(S,tell,C,M).",
    "@kqml_no_answer -!kqml::answer(S,C,M) <- .send(S,untell,C,M).",
)
ANSWER = predicate("answer", 3, namespace="kqml")
MYSELF = "self"


class Letter(NamedTuple):
    """A message that has been read: `content` is what its performative takes; `plans` are those of the program's own
    for it, if it has some."""

    message: Message
    content: Any
    plans: Options | None = None


class Hearing(Doing):
    """An agent that is told."""

    __slots__ = ("_default_plan", "_mailbox", "_read", "accepts")

    def __init__(self, name: str, actions: Iterable[str] | None, random_seed: int | None) -> None:
        super().__init__(name, actions, random_seed)
        self._mailbox: deque[Letter] = deque()
        self._read: dict[str, Literal] = {}
        self._default_plan: CompiledPlan | None = None
        self.accepts: Callable[[Message], bool] | None = None
        """Social acceptance: who may tell, ask and want what. A message for which it answers False is not obeyed.
        Answers to the agent's own questions are always taken."""

    # ---- the door: whatever is wrong is refused here, before anything changes --------------------------------------

    def read(self, message: Message) -> Letter:
        """Raises UnknownPerformative, AgentSpeakSyntaxError, NotALiteral."""
        if message.reply_to and self._is_waited_for(message.reply_to):
            return Letter(message, term_from(message.content))
        options = self.library.options(GOAL_ADDED, KQML_RECEIVED)
        if options:
            content = _content_of(message)
            plans = _named(relevant(options, _received(message, content)))
            if plans:
                return Letter(message, content, plans)
        try:
            return Letter(message, _performative(message).read(self, message.content))
        except StepFailed as problem:
            raise NotALiteral(message.content, problem) from problem

    def literal_of(self, content: Term | str) -> Literal:
        """What a message is about. Text without variables is remembered."""
        if type(content) is not str:
            return literal_from(content)
        literal = self._read.get(content)
        if literal is None:
            literal = literal_from(content)
            if len(self._read) >= REMEMBERED_TEXTS:
                self._read.clear()
            if is_ground(literal):
                self._read[content] = literal
        return literal

    # ---- one message -----------------------------------------------------------------------------------------------

    def process_message(self, letter: Letter) -> None:
        """One message of another agent."""
        message, content, plans = letter
        if message.reply_to and self._is_waited_for(message.reply_to):
            self._process_answer(message, content)
        elif self.accepts is not None and not self.accepts(message):
            return
        elif plans is None:
            self._obey(message, content)
        else:
            self._obey_own_plans(message, content, plans)

    def _obey(self, message: Message, content: Any) -> None:
        """What cannot be done is reported, as a goal would be."""
        try:
            _performative(message).obey(self, message, content)
        except StepFailed as failure:
            self._report(GoalFailure(f"{message.performative} of {message.sender}", failure.error, failure.message))

    def _obey_own_plans(self, message: Message, content: Term, plans: Options) -> None:
        """`+!kqml_received(SENDER, PERFORMATIVE, CONTENT, ID)`: plans of the program, then what is usual."""
        if message.performative in PERFORMATIVES:
            if self._default_plan is None:
                self._default_plan = CompiledPlan(parse_plan(DEFAULT_PLAN), self.library.compiler)
            plans = plans.followed_by(self._default_plan)
        self.achieve_apart(_received(message, content), plans)

    def obey(self, message: Message) -> None:
        """What is usual for this performative: .kqml.default. Raises StepFailed, AgentSpeakSyntaxError."""
        try:
            performative = _performative(message)
            performative.obey(self, message, performative.read(self, message.content))
        except (UnknownPerformative, NotALiteral) as problem:
            raise StepFailed("wrong_arguments", str(problem)) from problem

    def answer_by_plan(self, message: Message, question: Literal) -> bool:
        """Whether there is a plan `+?question`; what it finds out is the answer."""
        if not self.library.options(Trigger.TEST_ADDED, question.predicate):
            return False
        if not _named(self.library.options(GOAL_ADDED, ANSWER)):
            for plan in ANSWERING_PLANS:
                self.add_plan(parse_plan(plan))
        goal = Structure(ANSWER, (atom(message.sender), question, atom(message.id)))
        self.achieve_apart(goal, _named(self.library.options(GOAL_ADDED, ANSWER)))
        return True

    # ---- writing ---------------------------------------------------------------------------------------------------

    def post(self, message: Message) -> None:
        """.send, .broadcast. Raises StepFailed for what nobody could read."""
        if self._is_self(message.receiver):
            readers: Sequence[Reader] = (self,)
            message = replace(message, sender=MYSELF)
        else:
            readers = self.society.readers(message.receiver, self.name)
        if readers or not message.reply_to:  # what somebody outside waits for, only he knows
            _check_readable(message, readers or (self,))
        self.send(message)

    def send(self, message: Message) -> None:
        """What it writes to itself it reads in a cycle to come."""
        if self._is_self(message.receiver):
            self._mailbox.append(self.read(replace(message, sender=MYSELF)))
        else:
            super().send(message)

    def _is_self(self, receiver: str) -> bool:
        return receiver in (self.name, MYSELF)

    # ---- questions -------------------------------------------------------------------------------------------------

    def wait_for_answer(
        self, intention: Intention, message_id: str, answer: Term, deadline_s: float | None, receivers: Sequence[str]
    ) -> None:
        intention.state = State.ANSWER
        intention.waits_for = f"the answer of {' or '.join(receivers)}"
        if self.goal_states is not None:
            self.goal_states.tell_all(intention, "waiting", reason_of(intention))
        self.watches_clock = True
        self._asked[message_id] = Asked(intention, answer, deadline_s, frozenset(receivers))

    def questions_to(self, receiver: str) -> list[str]:
        """Ids of the messages that this one may still answer."""
        return [question for question, asked in self._asked.items() if receiver in asked.receivers]

    def _is_waited_for(self, question: str) -> bool:
        """Whether somebody waits for the answer, or did."""
        return question in self._asked or (question.endswith(WAITED_FOR) and question.startswith(f"{self.name}-"))

    def _process_answer(self, message: Message, answer: Term) -> None:
        asked = self._asked.pop(message.reply_to, None)
        if asked is None or asked.intention.number not in self.intentions:
            return  # too late: the time was over, or the intention was dropped
        if message.performative == "sorry":
            self._miss_answer(message, asked)
        elif message.performative == "untell":
            self._take_answer(asked.intention, asked.pattern, FALSE)
        else:
            sourced = _said_by(message.sender, answer)
            self._take_answer(asked.intention, asked.pattern, sourced)

    def _miss_answer(self, message: Message, asked: Asked) -> None:
        """One that was asked will not answer."""
        left = asked.receivers - {message.sender}
        if left:
            self._asked[message.reply_to] = asked._replace(receivers=left)
        else:
            self.fail(asked.intention, StepFailed("ask_failed", f"{message.sender} will not answer"))

    def _take_answer(self, intention: Intention, pattern: Term, answer: Term) -> None:
        if unify(pattern, answer, self.logic.trail):
            self.logic.trail.clear()
            self._go_on(intention)
        else:
            undo(self.logic.trail, 0)
            self.fail(intention, StepFailed("ask_failed", f"the answer is {show(answer)}, not {show(pattern)}"))


def _performative(message: Message) -> Performative:
    performative = PERFORMATIVES.get(message.performative)
    if performative is None:
        raise UnknownPerformative(message.performative)
    return performative


def _received(message: Message, content: Term) -> Literal:
    """+!kqml_received(bob,tell,p(1),id)"""
    return Structure(KQML_RECEIVED, (atom(message.sender), atom(message.performative), content, atom(message.id)))


def _said_by(sender: str, answer: Term) -> Term:
    """An answer, or each of a list, with its source."""
    if isinstance(answer, List):
        return List([_said_by(sender, each) for each in answer])
    return with_nested_source(answer, atom(sender)) if isinstance(answer, Structure | Atom) else answer


def _content_of(message: Message) -> Term:
    """As a plan for messages sees it. The text of a plan or event is no term."""
    if type(message.content) is str and message.performative in KNOW_HOW:
        return String(message.content)
    return term_from(message.content)


def _named(plans: Options) -> Options:
    """`+!G` takes any goal, but is no plan for messages."""
    return plans.part(tuple([place for place, each in enumerate(plans) if not isinstance(each.plan.head, Var)]))


def _check_readable(message: Message, readers: Iterable[Any]) -> None:
    """Somebody must be able to read it."""
    problems = []
    for reader in readers:
        try:
            reader.read(message)
        except BdiError as problem:
            problems.append(problem)
        else:
            return
    unknown = isinstance(problems[0], UnknownPerformative)
    raise StepFailed("unknown_performative" if unknown else "wrong_arguments", str(problems[0]))
