"""What somebody types into a search field."""

from typing import Any

from sqlalchemy import ColumnElement, or_
from sqlmodel import col


def says(search: str, *columns: Any) -> ColumnElement[bool]:
    """Whether one of these columns holds this text, in capitals or not."""
    return or_(*(col(column).icontains(search, autoescape=True) for column in columns))
