"""The robot's word on what it occupies: each bay, crossing and corridor is reported once, also through a restart."""

from collections.abc import Callable
from datetime import datetime
from typing import Final

from protocol.to_server import Evidence, Occupancy, Where
from robot.mission.outbox import Outbox
from robot.mission.store import Store

_FACT: Final = "occupied"


class OccupancyReports:
    """What was reported last is kept with the report."""

    def __init__(self, store: Store, outbox: Outbox, utc: Callable[[], datetime]) -> None:
        self._store, self._outbox, self._utc = store, outbox, utc
        self._last = self._kept()

    def report(
        self, where: Where, post: str, towards: str | None, evidence: Evidence, way_mm: int | None = None
    ) -> bool:
        """Report that it is wholly there; False if that was the last report."""
        if self._last is not None and (where, post, towards) == self._place(self._last):
            return False
        told = Occupancy(
            where=where, post=post, towards=towards, evidence=evidence, way_mm=way_mm, happened_at=self._utc()
        )
        with self._store.transaction() as database:
            row = _FACT, told.model_dump_json()
            database.execute("INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)", row)
            self._outbox.put(told)
        self._last = told
        return True

    def forget(self) -> None:
        """It was lifted or taken away: wherever it finds itself is news. Call it in the transaction of that."""
        self._last = None
        with self._store.transaction() as database:
            database.execute("DELETE FROM facts WHERE name = ?", (_FACT,))

    def _kept(self) -> Occupancy | None:
        with self._store.transaction() as database:
            row = database.execute("SELECT value FROM facts WHERE name = ?", (_FACT,)).fetchone()
        return Occupancy.model_validate_json(row[0]) if row else None

    @staticmethod
    def _place(told: Occupancy) -> tuple[Where, str, str | None]:
        return told.where, told.post, told.towards
