"""The agent as internal actions, messages and waits see it: its state, and a part for each kind of request.

`reasoning.agent.Agent` is one.
"""

from collections import deque
from collections.abc import Callable, Sequence
from random import Random
from typing import Protocol

from bdi.language.parser import Includes
from bdi.language.syntax import Plan, Program, Trigger
from bdi.language.terms import Atom, Literal, Term
from bdi.model.beliefs import Beliefs
from bdi.model.intentions import Event, Intention, Means, StepFailed
from bdi.model.messages import Message
from bdi.model.plans import Library, Options
from bdi.model.society import Society
from bdi.model.waiting import HasTime, Moment, Waiter


class Output(Protocol):
    """The outcome of the cycle."""

    def say(self, line: str) -> None: ...
    def new_message_id(self) -> str: ...


class EventQueue(Protocol):
    """Events of the world."""

    def notice(self, trigger: Trigger, literal: Literal) -> None: ...


class IntentionBase(Protocol):
    """Intentions, and events that have no plan yet."""

    def drop(self, intention: Intention) -> None: ...
    def drop_event(self, event: Event) -> None: ...
    def wait_for(self, intention: Intention, awaited: Moment | Waiter) -> None: ...


class Suspension(Protocol):
    """Goals that take no steps until they are resumed."""

    def suspend(self, intention: Intention) -> None: ...
    def suspend_goal(self, event: Event) -> None: ...
    def resume(self, intention: Intention) -> None: ...
    def resume_goal(self, event: Event) -> None: ...


class Recovery(Protocol):
    """Goals that count as reached or as failed."""

    def reach_goal(self, intention: Intention, is_goal: Callable[[Means], bool]) -> None: ...
    def reach_event(self, event: Event) -> None: ...
    def give_up_goal(self, intention: Intention, is_goal: Callable[[Means], bool], failure: StepFailed) -> None: ...
    def give_up_waiting(self, event: Event, failure: StepFailed) -> None: ...


class Actions(Protocol):
    """Beliefs and goals, as steps of plans change them."""

    def believe(self, literal: Literal, intention: Intention | None, last: bool = False) -> None: ...
    def forget(self, literal: Literal, intention: Intention | None) -> None: ...
    def forget_all(self, pattern: Literal) -> None: ...
    def achieve_apart(self, goal: Literal, options: Options | None = None) -> None: ...
    def ask_plans(self, intention: Intention, goal: Literal, options: Options) -> None: ...


class MessageHandling(Protocol):
    """Messages in both directions."""

    def literal_of(self, content: Term | str) -> Literal: ...
    def send(self, message: Message) -> None: ...
    def send_checked(self, message: Message) -> None: ...
    def obey(self, message: Message) -> None: ...
    def answer_by_plan(self, message: Message, question: Literal) -> bool: ...
    def wait_for_answer(
        self, intention: Intention, message_id: str, answer: Term, deadline_s: float | None, receivers: Sequence[str]
    ) -> None: ...


class PlanBase(Protocol):
    """Plans, and programs that are included."""

    def add(self, plan: Plan, first: bool = False) -> None: ...
    def remove(self, label: str) -> bool: ...
    def include(self, program: Program) -> None: ...


class Mind(HasTime, Protocol):
    """The state of an agent, and its parts."""

    name: str
    random: Random
    beliefs: Beliefs
    library: Library
    program: Program
    includes: Includes | None
    namespace_properties: dict[Atom, dict[Term, Term]]
    events: deque[Event]
    suspended_events: list[Event]
    intentions: dict[int, Intention]
    atomic: Intention | None
    current: Intention | None  # whose step is being taken; None in a condition
    considered: Event | None  # in the context of a plan: the event for which it is chosen
    timers: list[tuple[float, int, Intention]]
    waiters: list[Waiter]
    watches_clock: bool
    society: Society

    output: Output
    event_queue: EventQueue
    intention_base: IntentionBase
    suspension: Suspension
    recovery: Recovery
    actions: Actions
    message_handling: MessageHandling
    plan_base: PlanBase

    def say(self, line: str) -> None: ...
