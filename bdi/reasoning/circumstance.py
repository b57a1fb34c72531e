"""The state of an agent: beliefs, plans, events, intentions, and what they wait for."""

import random
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from bdi.builtin import Table
from bdi.builtin.registered import BoundActions
from bdi.debug.trace import Deliberated, GoalFailure
from bdi.language.parser import Includes
from bdi.language.syntax import Program
from bdi.language.terms import Atom, Term
from bdi.model import mind
from bdi.model.beliefs import Beliefs
from bdi.model.goal_states import GoalStates
from bdi.model.intentions import Event, Intention
from bdi.model.logic import Logic
from bdi.model.messages import Finished, Message
from bdi.model.plans import Library
from bdi.model.society import ALONE, Asked, Society
from bdi.model.subplans import Scopes
from bdi.model.waiting import Deadline, Waiter
from bdi.reasoning.percepts import Percepts

REMEMBERED = 50  # goals that were given up, and choices: what `why` looks back on


class Circumstance:
    """The data that the parts of an agent share; each part keeps what is its own.

    The parts that internal actions may call are named here by their interfaces (see `model.mind`).
    """

    __slots__ = (  # CPython finds so many attributes faster in slots than in a dictionary
        "__weakref__",
        "accepts",
        "actions",
        "asked",
        "atomic",
        "attentive",
        "beliefs",
        "bound_actions",
        "choices",
        "considered",
        "current",
        "cycles",
        "deadlines",
        "event_queue",
        "events",
        "feedback",
        "given_up",
        "goal_states",
        "has_conditions",
        "includes",
        "intention_base",
        "intentions",
        "internal_actions",
        "known_actions",
        "last_action",
        "last_intention",
        "library",
        "logic",
        "mailbox",
        "message_handling",
        "name",
        "namespace_properties",
        "now",
        "output",
        "pending",
        "percepts",
        "plan_base",
        "program",
        "random",
        "recovery",
        "running",
        "scopes",
        "selected",
        "society",
        "suspended_events",
        "suspension",
        "timers",
        "waiters",
        "watches_clock",
    )
    library: Library
    program: Program
    output: mind.Output
    event_queue: mind.EventQueue
    intention_base: mind.IntentionBase
    suspension: mind.Suspension
    recovery: mind.Recovery
    actions: mind.Actions
    message_handling: mind.MessageHandling
    plan_base: mind.PlanBase

    def __init__(
        self, name: str, actions: Iterable[str] | None, random_seed: int | None, internal_actions: Table | None
    ) -> None:
        self.name = name
        self.cycles = 0
        self.now = 0.0
        self.random = random.Random(random_seed)
        self.known_actions = None if actions is None else frozenset(actions)
        self.internal_actions = internal_actions  # its own, beside those of every agent
        self.bound_actions = BoundActions(self, internal_actions)
        self.includes: Includes | None = None  # what .include may read
        self.society: Society = ALONE
        self.accepts: Callable[[Message], bool] | None = None
        """Social acceptance: a message for which it returns False is not obeyed. Answers to the agent's own questions
        always are."""
        # beliefs and plans
        self.beliefs = Beliefs()
        self.logic = Logic(self.beliefs, self.bound_actions.find)
        self.namespace_properties: dict[Atom, dict[Term, Term]] = {}
        self.scopes: Scopes | None = None  # once a plan has sub-plans
        self.goal_states: GoalStates | None = None  # once a plan is about states of goals
        self.attentive = False  # whether goals have more to them: sub-plans, or plans about their states
        # percepts, events and intentions
        self.percepts = Percepts(self)
        self.events: deque[Event] = deque()
        self.suspended_events: list[Event] = []  # of suspended goals and intentions
        self.considered: Event | None = None  # the event for which a plan is or was last chosen
        self.intentions: dict[int, Intention] = {}
        self.running: deque[Intention] = deque()
        self.atomic: Intention | None = None
        self.current: Intention | None = None  # whose step is being taken
        self.selected: Intention | None = None  # whose turn this cycle was
        self.has_conditions = False  # whether an intention may have a goal condition
        self.last_intention = 0
        # what explanations look back on
        self.choices: deque[Deliberated] = deque(maxlen=REMEMBERED)  # while there are listeners
        self.given_up: deque[GoalFailure] = deque(maxlen=REMEMBERED)
        # input that waits for its turn, and what intentions wait for
        self.mailbox: deque[Any] = deque()
        self.feedback: deque[Finished] = deque()
        self.pending: dict[int, Intention] = {}  # by the action that each waits for
        self.last_action = 0
        self.asked: dict[str, Asked] = {}  # by message id
        self.timers: list[tuple[float, int, Intention]] = []
        self.waiters: list[Waiter] = []
        self.deadlines: dict[Event, list[Deadline]] = {}
        self.watches_clock = False  # whether there is a moment, an event, an answer or a deadline to wait for

    def say(self, line: str) -> None:
        """Print a line, as `.print` does."""
        self.output.say(line)
