"""Search fields: text as people type it."""

from typing import Annotated, Any

from pydantic import StringConstraints
from sqlalchemy import ColumnElement, or_
from sqlmodel import col

# PostgreSQL takes no zero byte. Invisible marks may be pasted along: then nothing is found.
SearchText = Annotated[str, StringConstraints(max_length=100, pattern=r"^[^\x00]*$")]


def says(search: str, *columns: Any) -> ColumnElement[bool]:
    """Return the condition that one of these columns holds this text, in capitals or not."""
    return or_(*(col(column).icontains(one, autoescape=True) for column in columns for one in _spellings(search)))


def _spellings(search: str) -> list[str]:
    """SQLite knows small and capital letters from a to z; what else there is has to be said in each way."""
    return [search] if search.isascii() else sorted({search.lower(), search.upper(), search.title()})
