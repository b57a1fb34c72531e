"""A stage for our agent program alone: percepts go in, actions must come out within so many cycles.

No robot, no clock, no thread: plain `Agent.cycle`. What the body would do is told by the test, but for what it always
does: it remembers that it charges, takes note that it was moved, and ends at once what says that a trouble is over.
"""

from bdi import Agent, Finished, Message, parse_program
from robot.ops.assembly import OUR_PROGRAM

PROGRAM = parse_program(OUR_PROGRAM.read_text("utf-8"), source=str(OUR_PROGRAM))
SOON = 40
AT_ONCE = ("clear_fault", "release", "set_destination")
TO_NOWHERE = "set_destination(nowhere)"


class Stage:
    """The agent, what it believes to perceive, and the actions that it waits for."""

    def __init__(self, *percepts: str) -> None:
        self.agent = Agent(PROGRAM, name="r1")
        self.percepts = set(percepts)
        self.waiting: dict[str, int] = {}
        self.done: list[str] = []
        self.cancelled: list[str] = []
        self.failures: list[str] = []
        self.now = 0.0
        self._at_once: list[str] = []
        self._finished: list[Finished] = []
        self._messages: list[Message] = []

    def cycle(self) -> list[str]:
        """One reasoning cycle; the actions that were started."""
        outcome = self.agent.cycle(frozenset(self.percepts), self._messages[:1], self._finished, self.now)
        self._messages, self._finished = self._messages[1:], []
        self.now += 0.1
        names = {id_: name for name, id_ in self.waiting.items()}
        for id_ in outcome.cancelled:
            self.cancelled.append(names[id_])
            del self.waiting[names[id_]]
        for action in outcome.actions:
            self.waiting[str(action.term)] = action.id
            if action.term.functor in AT_ONCE and str(action.term) != TO_NOWHERE:
                self.succeeds(str(action.term))
                self._at_once.append(str(action.term))
        self.failures += map(str, outcome.failures)
        return [str(action.term) for action in outcome.actions]

    def expect(self, action: str, within: int = SOON) -> None:
        """The agent must start this action soon (and wait for it)."""
        for _ in range(within):
            if action in self.waiting:
                return
            self.cycle()
        raise AssertionError(
            f"no {action} within {within} cycles; it waits for {sorted(self.waiting)}, did {self.done}"
        )

    def expect_cancelled(self, action: str, within: int = SOON) -> None:
        """The intention that waits for this action must be dropped soon."""
        for _ in range(within):
            if action in self.cancelled:
                return
            self.cycle()
        raise AssertionError(f"{action} was not cancelled within {within} cycles; cancelled {self.cancelled}")

    def does(self, *actions: str) -> None:
        """It starts these one after another, and each succeeds at once."""
        for action in actions:
            if action.partition("(")[0] in AT_ONCE:
                self._did(action)
            else:
                self.expect(action)
                self.succeeds(action)

    def _did(self, action: str) -> None:
        for _ in range(SOON):
            if action in self._at_once:
                self._at_once.remove(action)
                return
            self.cycle()
        raise AssertionError(f"no {action} within {SOON} cycles; it did {self.done}")

    def succeeds(self, action: str) -> None:
        self._finished.append(Finished(self.waiting.pop(action)))
        self.done.append(action)
        if action in ("report_charge(low)", "report_charge(charging)"):
            self.perceives("recharging")
        if action == "report_charge(charged)":
            self.perceives(without=("recharging",))
        if action == "noted_move":
            self.percepts = {term for term in self.percepts if not term.startswith("moved(")}

    def fails(self, action: str, reason: str) -> None:
        self._finished.append(Finished(self.waiting.pop(action), reason))

    def perceives(self, *added: str, without: tuple[str, ...] = ()) -> None:
        """These hold from now on, those no longer."""
        self.percepts = (self.percepts - set(without)) | set(added)

    def mail_changes_hands(self, what: str, number: int) -> None:
        """`what` is purpose, order and stop. As the body does it: the next stop is perceived in the same moment."""
        purpose, order, _ = what.split(",")
        carrying = f"carrying({order})"
        self.perceives("handing_over", f"next_stop({number + 1})", without=(f"next_stop({number})",))
        self.perceives(carrying) if purpose == "load" else self.perceives(without=(carrying,))

    def people_step_back(self, what: str) -> None:
        """The robot has stood for them."""
        self.perceives(without=("handing_over",))
        self.succeeds(f"wait_handover({what},600)")

    def reads(self, performative: str, content: str) -> None:
        self._messages.append(Message("user", performative, content))

    def settle(self, cycles: int = SOON) -> None:
        """Let it think; whatever it starts, it waits for."""
        for _ in range(cycles):
            self.cycle()

    # What happens between posts.

    def leaves(self) -> None:
        self.percepts = {term for term in self.percepts if not term.startswith(("at(", "direction("))}

    def reaches(self, post: str, *more: str) -> None:
        """follow_line ends at a post."""
        self.leaves()
        self.percepts |= {f"at({post})", *more}
        self.succeeds("follow_line")
