"""The turns that were made last, kept through a restart."""

from typing import Final

from pydantic import TypeAdapter

from robot.localization.counted_turn import NOT_TURNED, Turned
from robot.mission.store import Store

_FACT: Final = "turned"
_TURNED: Final = TypeAdapter(Turned)


class TurnRecord:
    """As they were written down, before the wheels began to turn or right after."""

    def __init__(self, store: Store) -> None:
        self._store = store

    def keep(self, turned: Turned) -> None:
        with self._store.transaction() as database:
            row = _FACT, _TURNED.dump_json(turned).decode()
            database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", row)

    def kept(self) -> Turned:
        with self._store.transaction() as database:
            row = database.execute("SELECT value FROM facts WHERE name = ?", (_FACT,)).fetchone()
        return _TURNED.validate_json(row[0]) if row else NOT_TURNED
