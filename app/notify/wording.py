"""A notice in words, the same on every channel."""

from app.tables import Notice
from app.texts import text
from app.texts.reasons import in_words


def title_of(notice: Notice, language: str) -> str:
    """Never holds a hand-over code: a phone shows it on its locked screen."""
    return text(language, f"notice.{notice.kind}.title", notice.facts)


def body_of(notice: Notice, language: str) -> str:
    return text(language, f"notice.{notice.kind}.body", in_words(language, notice.facts))
