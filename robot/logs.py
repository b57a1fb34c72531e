"""Where the log goes: to stderr, which systemd's journal keeps and rotates, or into a file that rotates by itself.

No loop logs its ticks: a line is written when something has changed.
"""

import logging
import sys
from logging.handlers import RotatingFileHandler
from pathlib import Path

import structlog

from .config import ConfigError

LONGEST_FILE_BYTES = 1_000_000
KEPT_FILES = 4


def configure_logs(path: Path | None) -> None:
    """For the whole process. Raises ConfigError when the file cannot be opened; stdout stays free for --json."""
    if path is None:
        structlog.configure(logger_factory=lambda *_: structlog.PrintLogger(sys.stderr))
        return
    logger = logging.getLogger("robot")
    for old in tuple(logger.handlers):
        logger.removeHandler(old)
        old.close()
    logger.addHandler(_file(path))
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


def _file(path: Path) -> RotatingFileHandler:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handler = RotatingFileHandler(path, maxBytes=LONGEST_FILE_BYTES, backupCount=KEPT_FILES, encoding="utf-8")
    except OSError as error:
        raise ConfigError(str(path), "log_file", f"cannot be written: {error.strerror}") from None
    handler.setFormatter(logging.Formatter("%(message)s"))
    return handler
