"""Whoever logs waits for no disk."""

import logging
import threading

from robot.logs import WAITING_LINES, WrittenElsewhere


class Card(logging.Handler):
    """Writes nothing until it is let."""

    def __init__(self) -> None:
        super().__init__()
        self.hangs = threading.Event()
        self.lines: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        self.hangs.wait()
        self.lines.append(record.getMessage())


def test_a_card_that_hangs_keeps_nobody_waiting_and_what_there_is_room_for_is_written_in_the_end() -> None:
    card = Card()
    handler = WrittenElsewhere(card)
    for number in range(2 * WAITING_LINES):
        handler.handle(logging.LogRecord("robot", logging.INFO, __file__, 1, f"line {number}", None, None))
    assert card.lines == []
    threading.Timer(0.05, card.hangs.set).start()
    handler.close()
    assert card.lines[:2] == ["line 0", "line 1"]
    assert WAITING_LINES <= len(card.lines) < 2 * WAITING_LINES
