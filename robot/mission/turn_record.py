"""The turn that was begun last, kept through a restart."""

from typing import Final

from pydantic import TypeAdapter

from robot.localization.counted_turn import TurnBegun
from robot.mission.store import Store

_FACT: Final = "turn"
_TURN: Final = TypeAdapter[TurnBegun | None](TurnBegun | None)


class TurnRecord:
    """None: no turn is under way, or the way the robot looked was not known."""

    def __init__(self, store: Store) -> None:
        self._store = store

    def keep(self, turn: TurnBegun | None) -> None:
        with self._store.transaction() as database:
            row = _FACT, _TURN.dump_json(turn).decode()
            database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", row)

    def kept(self) -> TurnBegun | None:
        with self._store.transaction() as database:
            row = database.execute("SELECT value FROM facts WHERE name = ?", (_FACT,)).fetchone()
        return _TURN.validate_json(row[0]) if row else None
