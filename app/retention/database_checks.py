"""Checks of a database: whole, at a known schema, and telling one story of each order."""

from collections.abc import Iterator
from typing import Any, Final

from sqlalchemy import Connection, inspect, text

OF_EVERY_REVISION: Final = frozenset({"orders", "order_events", "people", "robots", "robot_journals", "robot_messages"})
"""What a database of ours has had since the first schema; a backup may be older than the newest one."""
MOST: Final = 20
"""Problems of one kind that are named; the rest would say no more."""

CONTRADICTIONS: Final = {
    "order {0} has no event: its origin is unknown": """
        SELECT id FROM orders WHERE NOT EXISTS (SELECT 1 FROM order_events e WHERE e.order_id = orders.id)""",
    "order {0} is at version {1}, and its events go from {2} to {3}": """
        SELECT o.id, max(o.version), min(e.seq), max(e.seq) FROM orders o JOIN order_events e ON e.order_id = o.id
        GROUP BY o.id HAVING min(e.seq) <> 1 OR max(e.seq) > max(o.version)""",
    "order {0} is {1}, but its last event says {2}": """
        SELECT o.id, o.state, e.state FROM orders o JOIN order_events e ON e.order_id = o.id
        WHERE e.seq = (SELECT max(seq) FROM order_events l WHERE l.order_id = o.id) AND e.state <> o.state""",
    "robot {0} said {2} in journal {1}, and only {3} counts as received": """
        SELECT j.robot, j.journal, max(m.seq), max(j.received_seq) FROM robot_journals j
        JOIN robot_messages m ON m.robot = j.robot AND m.journal = j.journal
        GROUP BY j.robot, j.journal HAVING max(m.seq) > max(j.received_seq)""",
    "robot {0} was written message {1}, beyond its last number {2}": """
        SELECT r.name, max(m.seq), max(r.last_seq) FROM robots r JOIN server_outbox m ON m.robot = r.name
        GROUP BY r.name HAVING max(m.seq) > max(r.last_seq)""",
}
"""What must not be true of any row, as a sentence and the rows for which it is. SQL that both databases take."""


def problems_of(connection: Connection) -> list[str]:
    """Every problem as a sentence; none is what one hopes for."""
    found = list(_broken_files(connection))
    if found:
        return found  # what cannot be read cannot contradict itself
    missing = OF_EVERY_REVISION - set(inspect(connection).get_table_names())
    if missing:
        return [f"tables are missing: {', '.join(sorted(missing))}"]
    return list(_contradictions(connection))


def _broken_files(connection: Connection) -> Iterator[str]:
    """PostgreSQL keeps to its constraints by itself; a SQLite file may have been damaged, or edited without them."""
    if connection.dialect.name != "sqlite":
        return
    for (word,) in connection.execute(text("PRAGMA integrity_check")):
        if word != "ok":
            yield f"integrity: {word}"
    rows: Any = connection.execute(text("PRAGMA foreign_key_check")).fetchmany(MOST)
    for table, rowid, parent, _ in rows:
        yield f"foreign key: row {rowid} of {table} refers to a row of {parent} that is not there"


def _contradictions(connection: Connection) -> Iterator[str]:
    for sentence, rows in CONTRADICTIONS.items():
        for row in connection.execute(text(rows)).fetchmany(MOST):
            yield sentence.format(*row)
