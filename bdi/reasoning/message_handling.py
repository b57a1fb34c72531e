"""Messages of other agents: checked on arrival, processed one a cycle; questions and their answers."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from bdi.debug.trace import GoalFailure
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
from bdi.reasoning.actions import Actions
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.intention_base import IntentionBase
from bdi.reasoning.output import Output
from bdi.reasoning.percepts import REMEMBERED_TEXTS
from bdi.reasoning.performatives import KNOW_HOW, PERFORMATIVES, Performative, with_nested_source
from bdi.reasoning.recovery import Recovery

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


class MessageHandling:
    """Reads messages, obeys them, sends them, and waits for answers."""

    __slots__ = ("_default_plan", "_read", "actions", "agent", "intention_base", "output", "recovery")

    def __init__(
        self, agent: Circumstance, output: Output, intention_base: IntentionBase, recovery: Recovery, actions: Actions
    ) -> None:
        self.agent = agent
        self.output = output
        self.intention_base = intention_base
        self.recovery = recovery
        self.actions = actions
        self._read: dict[str, Literal] = {}
        self._default_plan: CompiledPlan | None = None

    # ---- on arrival: a wrong message is refused before anything changes ----------------------------------------------

    def read(self, message: Message) -> Letter:
        """Raises UnknownPerformative, AgentSpeakSyntaxError, NotALiteral."""
        if message.reply_to and self._is_waited_for(message.reply_to):
            return Letter(message, term_from(message.content))
        options = self.agent.library.options(GOAL_ADDED, KQML_RECEIVED)
        if options:
            content = _content_of(message)
            plans = _named(relevant(options, _received(message, content)))
            if plans:
                return Letter(message, content, plans)
        try:
            return Letter(message, _performative(message).read(self.agent, message.content))
        except StepFailed as problem:
            raise NotALiteral(message.content, problem) from problem

    def literal_of(self, content: Term | str) -> Literal:
        """Return the content of a message as a literal. Text without variables is cached."""
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

    # ---- one message -------------------------------------------------------------------------------------------------

    def process(self, letter: Letter) -> None:
        """One message of another agent."""
        message, content, plans = letter
        if message.reply_to and self._is_waited_for(message.reply_to):
            self._process_answer(message, content)
        elif self.agent.accepts is not None and not self.agent.accepts(message):
            return
        elif plans is None:
            self._obey(message, content)
        else:
            self._obey_own_plans(message, content, plans)

    def _obey(self, message: Message, content: Any) -> None:
        """Obey a message; report a failure as that of a goal."""
        try:
            _performative(message).obey(self.agent, message, content)
        except StepFailed as failure:
            self.output.report(
                GoalFailure(f"{message.performative} of {message.sender}", failure.error, failure.message)
            )

    def _obey_own_plans(self, message: Message, content: Term, plans: Options) -> None:
        """`+!kqml_received(SENDER, PERFORMATIVE, CONTENT, ID)`: plans of the program, then what is usual."""
        if message.performative in PERFORMATIVES:
            if self._default_plan is None:
                self._default_plan = CompiledPlan(parse_plan(DEFAULT_PLAN), self.agent.library.compiler)
            plans = plans.followed_by(self._default_plan)
        self.actions.achieve_apart(_received(message, content), plans)

    def obey(self, message: Message) -> None:
        """Obey a message in the default way: .kqml.default. Raises StepFailed, AgentSpeakSyntaxError."""
        try:
            performative = _performative(message)
            performative.obey(self.agent, message, performative.read(self.agent, message.content))
        except (UnknownPerformative, NotALiteral) as problem:
            raise StepFailed("wrong_arguments", str(problem)) from problem

    def answer_by_plan(self, message: Message, question: Literal) -> bool:
        """Start a plan `+?question`, whose result is the answer. Return False if there is none."""
        if not self.agent.library.options(Trigger.TEST_ADDED, question.predicate):
            return False
        if not _named(self.agent.library.options(GOAL_ADDED, ANSWER)):
            for plan in ANSWERING_PLANS:
                self.agent.plan_base.add(parse_plan(plan))
        goal = Structure(ANSWER, (atom(message.sender), question, atom(message.id)))
        self.actions.achieve_apart(goal, _named(self.agent.library.options(GOAL_ADDED, ANSWER)))
        return True

    # ---- send --------------------------------------------------------------------------------------------------------

    def send_checked(self, message: Message) -> None:
        """Send a message if a receiver can read it: .send, .broadcast. Raises StepFailed otherwise."""
        if self._is_self(message.receiver):
            readers: Sequence[Reader] = (self,)
            message = replace(message, sender=MYSELF)
        else:
            readers = self.agent.society.readers(message.receiver, self.agent.name)
        if readers or not message.reply_to:  # an outside receiver decides for itself
            _check_readable(message, readers or (self,))
        self.send(message)

    def send(self, message: Message) -> None:
        """Send a message; one to the agent itself is read in a later cycle."""
        if self._is_self(message.receiver):
            self.agent.mailbox.append(self.read(replace(message, sender=MYSELF)))
        else:
            self.output.send(message)

    def _is_self(self, receiver: str) -> bool:
        return receiver in (self.agent.name, MYSELF)

    # ---- questions ---------------------------------------------------------------------------------------------------

    def wait_for_answer(
        self, intention: Intention, message_id: str, answer: Term, deadline_s: float | None, receivers: Sequence[str]
    ) -> None:
        intention.state = State.ANSWER
        intention.waits_for = f"the answer of {' or '.join(receivers)}"
        if self.agent.goal_states is not None:
            self.agent.goal_states.tell_all(intention, "waiting", reason_of(intention))
        self.agent.watches_clock = True
        self.agent.asked[message_id] = Asked(intention, answer, deadline_s, frozenset(receivers))

    def questions_to(self, receiver: str) -> list[str]:
        """Ids of the messages that this one may still answer."""
        return [question for question, asked in self.agent.asked.items() if receiver in asked.receivers]

    def _is_waited_for(self, question: str) -> bool:
        """Return whether an intention waits for the answer, or did."""
        return question in self.agent.asked or (
            question.endswith(WAITED_FOR) and question.startswith(f"{self.agent.name}-")
        )

    def _process_answer(self, message: Message, answer: Term) -> None:
        asked = self.agent.asked.pop(message.reply_to, None)
        if asked is None or asked.intention.number not in self.agent.intentions:
            return  # too late: the time was over, or the intention was dropped
        if message.performative == "sorry":
            self._miss_answer(message, asked)
        elif message.performative == "untell":
            self.take_answer(asked.intention, asked.pattern, FALSE)
        else:
            sourced = _said_by(message.sender, answer)
            self.take_answer(asked.intention, asked.pattern, sourced)

    def _miss_answer(self, message: Message, asked: Asked) -> None:
        """One that was asked will not answer."""
        left = asked.receivers - {message.sender}
        if left:
            self.agent.asked[message.reply_to] = asked._replace(receivers=left)
        else:
            self.recovery.fail(asked.intention, StepFailed("ask_failed", f"{message.sender} will not answer"))

    def take_answer(self, intention: Intention, pattern: Term, answer: Term) -> None:
        if unify(pattern, answer, self.agent.logic.trail):
            self.agent.logic.trail.clear()
            self.intention_base.go_on(intention)
        else:
            undo(self.agent.logic.trail, 0)
            self.recovery.fail(
                intention, StepFailed("ask_failed", f"the answer is {show(answer)}, not {show(pattern)}")
            )


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
    """Return the content as a plan for messages sees it. The text of a plan or event is no term."""
    if type(message.content) is str and message.performative in KNOW_HOW:
        return String(message.content)
    return term_from(message.content)


def _named(plans: Options) -> Options:
    """`+!G` takes any goal, but is no plan for messages."""
    return plans.part(tuple([place for place, each in enumerate(plans) if not isinstance(each.plan.head, Var)]))


def _check_readable(message: Message, readers: Iterable[Any]) -> None:
    """Check that at least one receiver can read the message."""
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
