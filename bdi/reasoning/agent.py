"""The reasoning cycle.

    cycle ─ sense ──────── perceive                what the body sees: deletions, then additions     sensing
          │              └ process                 one message a cycle                       message_handling
          ├ wake                                   what waited for a moment or an event; deadlines   sensing
          ├ deliberate ─── select_event            first in, first out                             selection
          │              ├ select_plan             the first applicable plan in source order    deliberation
          │              └ add_means               on a new intention, or on the one that waits for this event
          └ act ────────── process_feedback        one finished action a cycle                     execution
                         ├ select_intention        round robin                                     selection
                         └ step                    one step of one plan body

An agent is its state (`circumstance`) and one part for each of these jobs, named at the right. Nothing here knows a
clock, a thread or a device: everything comes in by `cycle` and goes out by its answer.
"""

from collections.abc import Callable, Iterable
from typing import Any

from bdi.builtin import Table
from bdi.debug.explain import Why, explain
from bdi.debug.trace import TraceEntry
from bdi.language.parser import Includes, literal_from, term_from
from bdi.language.syntax import Plan, Program
from bdi.language.terms import Term
from bdi.model.messages import Finished, Message
from bdi.model.plans import Compiler
from bdi.reasoning.actions import Actions
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.deadlines import DeadlineWatch
from bdi.reasoning.deliberation import Deliberation
from bdi.reasoning.event_queue import EventQueue
from bdi.reasoning.execution import Execution
from bdi.reasoning.intention_base import IntentionBase, Suspension
from bdi.reasoning.message_handling import MessageHandling
from bdi.reasoning.output import QUIET, Outcome, Output
from bdi.reasoning.plan_base import PlanBase
from bdi.reasoning.recovery import Recovery
from bdi.reasoning.selection import Selection
from bdi.reasoning.sensing import Sensing


class Agent(Circumstance):
    """One AgentSpeak agent.

    `actions` declares the external actions that the body can do, as names or name/arity ("drive", "drive/1"); a plan
    with another one is then refused with UnknownAction. Without it every action is taken as known.
    `internal_actions` are those that this agent has beside ours (see `user_actions`). `includes` says what `.include`
    may read while the agent runs; without it, nothing.
    """

    __slots__ = ("deliberation", "execution", "recorder", "sensing")
    output: Output
    message_handling: MessageHandling
    plan_base: PlanBase

    def __init__(
        self,
        program: Program,
        name: str = "agent",
        actions: Iterable[str] | None = None,
        random_seed: int | None = None,
        internal_actions: Table | None = None,
        *,
        includes: Includes | None = None,
    ) -> None:
        super().__init__(name, actions, random_seed, internal_actions)
        self.includes = includes
        self.recorder: Any = None  # runs the cycle instead, to record it
        self._assemble()
        self.plan_base.load(program)
        self.program = program

    def _assemble(self) -> None:
        """Make the parts; each is given those that it uses."""
        output = self.output = Output(self)
        queue = self.event_queue = EventQueue(self)
        base = self.intention_base = IntentionBase(self, output)
        self.suspension = Suspension(self, base)
        recovery = self.recovery = Recovery(self, output, queue, base)
        base.on_failure = recovery.fail
        deadlines = DeadlineWatch(self, output, recovery)
        actions = self.actions = Actions(self, output, queue, base, deadlines)
        messages = self.message_handling = MessageHandling(self, output, base, recovery, actions)
        selection = Selection(self, base.drop)
        self.plan_base = PlanBase(self, actions, selection)
        self.sensing = Sensing(self, output, queue, base, recovery, deadlines, messages)
        self.deliberation = Deliberation(self, output, base, recovery, selection)
        self.execution = Execution(self, output, base, recovery, selection)
        actions.step, actions.learn = self.execution.step, self.plan_base.learn
        self.library = Compiler(actions, self.logic).library

    def add_plan(self, plan: Plan, first: bool = False) -> None:
        self.plan_base.add(plan, first)

    def load(self, program: Program) -> None:
        """Add more of the program while the agent is running. Raises as the agent's making does."""
        self.plan_base.include(program)

    # ---- the cycle -------------------------------------------------------------------------------------------------

    def cycle(
        self,
        percepts: Iterable[Term | str] | None = None,
        messages: Iterable[Message] = (),
        finished: Iterable[Finished] = (),
        now: float = 0.0,
    ) -> Outcome:
        """Run one reasoning cycle.

        `percepts` is all that is perceived now (None: nothing new), `finished` the actions that are over since the
        last cycle, `now` a clock in seconds that never goes back. Terms may be given as text.

        Raises AgentSpeakSyntaxError for text that is none, NotALiteral for a term that is none, UnknownPerformative,
        and UnknownActionId for an action that was never started. Then nothing has happened: the agent is as before.
        """
        change = None if percepts is None else self.percepts.change(percepts)
        letters = [self.message_handling.read(message) for message in messages] if messages else ()
        ended = self.execution.started(finished) if finished else ()
        self.now = now
        self.cycles += 1
        # sense
        if change is not None:
            self.sensing.perceive(change)
        if letters:
            self.mailbox.extend(letters)
        if self.mailbox:
            self.message_handling.process(self.mailbox.popleft())
        if ended:
            self.feedback.extend(ended)
        if self.watches_clock:
            self.sensing.wake()
        if self.events:
            self.deliberation.deliberate()
        self.execution.act()
        output = self.output
        return output.take() if output.reported or output.actions else QUIET

    # ---- looking in ------------------------------------------------------------------------------------------------

    def ask(self, formula: Term | str) -> list[dict[str, Term]]:
        """Return all answers to a formula over the beliefs, each as name → value."""
        return self.logic.query(term_from(formula))

    def believes(self, formula: Term | str) -> bool:
        return bool(self.ask(formula))

    @property
    def idle(self) -> bool:
        """Return True if nothing is left to do until something comes in: no percept, message or news of an action is
        due, and no wait has an end."""
        waits = [waiter.deadline_s for waiter in self.waiters] + [asked[2] for asked in self.asked.values()]
        busy = self.events or self.running or self.mailbox or self.feedback or self.pending
        ends = self.timers or self.deadlines
        return not busy and not ends and all(deadline_s is None for deadline_s in waits)

    def listen(self, callback: Callable[[TraceEntry], None], explain: bool = False) -> None:
        """Call this for every choice, step and change, and fill `outcome.trace`. With `explain` each choice also says
        of every plan why it was or was not taken, which costs much more time."""
        self.output.listen(callback, explain)

    def stop_listening(self, callback: Callable[[TraceEntry], None]) -> None:
        """Stop. The remembered choices go with the last listener: without one, none are added."""
        self.output.stop_listening(callback)

    def why(self, goal: Term | str) -> Why:
        """Return why a goal is not reached yet, in words and as data."""
        return explain(self, literal_from(goal))
