"""Logs: one line per event, and never a token, a code or a cookie in them."""

import logging
import re
import sys
from typing import Any

import structlog

from protocol.one_line import escaped

SECRET_KEYS = frozenset({"authorization", "code", "cookie", "password", "secret", "session", "set-cookie", "token"})
SECRET_TEXTS = re.compile(
    r"CM1:[0-9a-f]{32}|\bcm[a-z]_[A-Za-z0-9]+_[A-Za-z0-9_-]+|(?<=[Bb]earer )[^\s'\"]+"
    r"|\b(?:session|oidc|browser)=[^\s;]+|\b\d{8}\b|\b\d{6}\b"
)
REDACTED = "[redacted]"


def redact(logger: Any, method: str, event: structlog.typing.EventDict) -> structlog.typing.EventDict:
    """Take secrets out of one log event: by the key's name, and by how secrets of ours look."""
    return {key: REDACTED if key.lower() in SECRET_KEYS else _redacted(value) for key, value in event.items()}


def _redacted(value: Any) -> Any:
    if isinstance(value, str):
        return SECRET_TEXTS.sub(REDACTED, value)
    if isinstance(value, dict):
        return {k: REDACTED if str(k).lower() in SECRET_KEYS else _redacted(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_redacted(one) for one in value]
    return value


def escape(logger: Any, method: str, event: structlog.typing.EventDict) -> structlog.typing.EventDict:
    """Keep each event on its one line at a terminal, and its letters in their order. JSON does so itself."""
    return {key: escaped(value) if isinstance(value, str) else value for key, value in event.items()}


def set_up_logs(level: str, as_json: bool | None = None) -> None:
    """Send structlog and the standard library's loggers to stderr; `level` is a name such as INFO.

    `as_json` None: lines for people at a terminal, else one JSON object a line, for whatever collects them.
    """
    as_json = not sys.stderr.isatty() if as_json is None else as_json
    shared: list[structlog.typing.Processor] = [
        structlog.contextvars.merge_contextvars,
        structlog.stdlib.add_log_level,
        structlog.stdlib.add_logger_name,
        # The log's own times are the machine's: they are for its reader, not part of any record.
        structlog.processors.TimeStamper(fmt="iso", utc=True),
        structlog.processors.format_exc_info,
    ]
    structlog.configure(
        processors=[*shared, structlog.stdlib.ProcessorFormatter.wrap_for_formatter],
        logger_factory=structlog.stdlib.LoggerFactory(),
        cache_logger_on_first_use=True,
    )
    last: list[structlog.typing.Processor] = [
        structlog.stdlib.ProcessorFormatter.remove_processors_meta,
        redact,
        *(
            [structlog.processors.JSONRenderer(default=str)]
            if as_json
            else [escape, structlog.processors.LogfmtRenderer()]
        ),
    ]
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(structlog.stdlib.ProcessorFormatter(processors=last, foreign_pre_chain=shared))
    logging.basicConfig(level=level, handlers=[handler], force=True)
    for chatty in ("sqlalchemy", "alembic", "httpcore", "httpx", "uvicorn.access"):
        logging.getLogger(chatty).setLevel(max(logging.WARNING, logging.getLevelName(level)))
