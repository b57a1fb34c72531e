"""The actions that are under way: begun, looked after, cancelled, and ended by name."""

from collections.abc import Iterable, Sequence
from typing import Final, Protocol

import structlog

from maps import CampusMapError
from robot.agent.actions.arguments import WrongArguments, checked
from robot.agent.actions.hands import PLACE_UNKNOWN, Hands
from robot.agent.actions.runs import AtOnce, Ended, Ends, Run
from robot.agent.actions.table import ACTIONS, PAPER_ACTIONS, Action
from robot.core.config import PerceptMode
from robot.mission.mission import NoSuchStop

log = structlog.get_logger("robot.actions")

UNKNOWN: Final = "unknown_action"


class Term(Protocol):
    """The part of a term that actions need: `turn(left)` has the functor turn and one argument."""

    @property
    def functor(self) -> str: ...

    @property
    def args(self) -> Sequence[object]: ...


class Actions:
    """By the id that the mind gave each of them."""

    def __init__(self, hands: Hands, table: Iterable[Action]) -> None:
        self._hands = hands
        self._table = {(action.name, len(action.takes)): action for action in table}
        self._runs: dict[int, Run] = {}
        self._terms: dict[int, str] = {}
        self._dropped: list[Run] = []
        self._is_off_the_map = False

    @property
    def under_way(self) -> tuple[str, ...]:
        """The actions that have not ended, as the program wrote them, oldest first."""
        return tuple(self._terms.values())

    def begin(self, action_id: int, term: Term, now: float) -> None:
        """Start what the agent asks for. What cannot be started ends at once, failed by name."""
        self._terms[action_id] = str(term)
        self._runs[action_id] = self._run(term, now)

    def _run(self, term: Term, now: float) -> Run:
        try:
            action = self._action(term)
            return action.begin(
                self._hands, checked(term.functor, action.takes, term.args, self._hands.navigator.campus), now
            )
        except WrongArguments as error:
            self._hands.noted(f"cannot do {term}: {error}")
            return AtOnce(Ended(error.reason))
        except NoSuchStop as error:
            # The mission was taken back while the agent was about to do its next step.
            self._hands.noted(f"cannot do {term}: {error}")
            return AtOnce(Ended("no_such_stop"))
        except CampusMapError as error:
            return AtOnce(self._off_the_map(error))

    def _off_the_map(self, error: CampusMapError) -> Ended:
        log.error("map_error", error=repr(error), exc_info=error)
        self._hands.lose_place(error)
        self._is_off_the_map = True
        return Ended(PLACE_UNKNOWN)

    def _action(self, term: Term) -> Action:
        action = self._table.get((term.functor, len(term.args)))
        if action:
            return action
        forms = [action for (name, _), action in self._table.items() if name == term.functor]
        if forms:
            checked(term.functor, forms[0].takes, term.args, self._hands.navigator.campus)
        raise WrongArguments(UNKNOWN, f"this robot knows no action {term.functor}")

    def _poll(self, run: Run, ends: Ends, now: float) -> Ended | None:
        try:
            return run.poll(ends, now)
        except CampusMapError as error:
            run.cancel()
            return self._off_the_map(error)

    def fail_all(self, reason: str) -> None:
        """Everything under way ends, and with it every motion."""
        for run in self._runs.values():
            run.cancel()
        self._dropped += self._runs.values()
        self._runs = {id_: AtOnce(Ended(reason)) for id_ in self._runs}

    def finished(self, now: float) -> list[tuple[int, str | None]]:
        """Those that have ended since the last call, with the atom that says why if they failed."""
        if self._is_off_the_map:
            self._is_off_the_map = False
            self.fail_all(PLACE_UNKNOWN)
        ends = {end.job: end for end in self._hands.body.finished()}
        self._dropped = [run for run in self._dropped if self._poll(run, ends, now) is None]
        ended = [(id_, self._poll(run, ends, now)) for id_, run in self._runs.items()]
        done = [(id_, end.failure) for id_, end in ended if end]
        for id_, failure in done:
            if failure:
                self._hands.noted(f"{self._terms[id_]} failed: {failure}")
            del self._runs[id_], self._terms[id_]
        return done

    def cancel(self, action_ids: Iterable[int]) -> None:
        """Their intentions were dropped: the body stops them before it starts anything new.

        One that was done at that very moment is done: mail that has changed hands is written down though no plan asks.
        """
        for id_ in action_ids:
            if id_ in self._runs:
                run = self._runs.pop(id_)
                run.cancel()
                self._dropped.append(run)
                del self._terms[id_]


def table_for(mode: PerceptMode) -> tuple[Action, ...]:
    """Ours first; a program that drains its percepts speaks the paper's words, so there these come last and win."""
    return (*PAPER_ACTIONS, *ACTIONS) if mode is PerceptMode.LATEST else (*ACTIONS, *PAPER_ACTIONS)
