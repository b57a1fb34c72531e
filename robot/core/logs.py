"""Where the log goes: to stderr, which systemd's journal keeps and rotates, or into a file that rotates by itself.

No loop logs its ticks: a line is written when something has changed. The drive loop logs as well, so that the file is
written by a thread of its own.
"""

import logging
import sys
import threading
from contextlib import suppress
from logging.handlers import RotatingFileHandler
from pathlib import Path
from queue import Full, Queue

import structlog

from robot.core.config import ConfigError

LONGEST_FILE_BYTES = 1_000_000
KEPT_FILES = 4
WAITING_LINES = 1000
"""For a card that hangs; what comes beyond that is lost, and no thread waits."""
CLOSE_WITHIN_S = 3.0


def configure_logs(path: Path | None) -> None:
    """For the whole process. Raises ConfigError when the file cannot be opened; stdout stays free for --json."""
    if path is None:
        structlog.configure(
            processors=[
                structlog.contextvars.merge_contextvars,
                structlog.processors.add_log_level,
                structlog.processors.TimeStamper(fmt="%Y-%m-%d %H:%M:%S", utc=False),
                # structlog's own choice prints all local variables: tokens too, and it takes seconds of a drive loop.
                structlog.dev.ConsoleRenderer(exception_formatter=structlog.dev.plain_traceback),
            ],
            logger_factory=lambda *_: structlog.PrintLogger(sys.stderr),
        )
        return
    logger = logging.getLogger("robot")
    for old in tuple(logger.handlers):
        logger.removeHandler(old)
        old.close()
    logger.addHandler(WrittenElsewhere(_file(path)))
    logger.setLevel(logging.INFO)
    logger.propagate = False
    structlog.configure(
        processors=[
            structlog.processors.add_log_level,
            structlog.processors.TimeStamper(fmt="iso", utc=True),
            structlog.processors.format_exc_info,
            structlog.processors.JSONRenderer(sort_keys=False),
        ],
        logger_factory=lambda *_: logger,
        wrapper_class=structlog.make_filtering_bound_logger(logging.INFO),
    )


class WrittenElsewhere(logging.Handler):
    """Hands lines over to a thread; closing it writes what still waits."""

    def __init__(self, writer: logging.Handler) -> None:
        super().__init__()
        self._writer = writer
        self._waiting: Queue[logging.LogRecord | None] = Queue(WAITING_LINES)
        self._thread = threading.Thread(target=self._write_all, name="log", daemon=True)
        self._thread.start()

    def emit(self, record: logging.LogRecord) -> None:
        with suppress(Full):
            self._waiting.put_nowait(record)

    def _write_all(self) -> None:
        while (record := self._waiting.get()) is not None:
            self._writer.handle(record)
        self._writer.close()

    def close(self) -> None:
        with suppress(Full):
            self._waiting.put(None, timeout=CLOSE_WITHIN_S)
        self._thread.join(CLOSE_WITHIN_S)
        super().close()


def _file(path: Path) -> RotatingFileHandler:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handler = RotatingFileHandler(path, maxBytes=LONGEST_FILE_BYTES, backupCount=KEPT_FILES, encoding="utf-8")
    except OSError as error:
        raise ConfigError(str(path), "log_file", f"cannot be written: {error.strerror}") from None
    handler.setFormatter(logging.Formatter("%(message)s"))
    return handler
