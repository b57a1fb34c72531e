"""The parts that the service was composed of, found by type: what routes get as arguments."""

from typing import Any, TypeVar

from fastapi import Depends
from starlette.requests import HTTPConnection

T = TypeVar("T")


def find_part(connection: HTTPConnection, kind: type[T]) -> T:
    """Return the part of this type. Raises KeyError where the service was composed without one."""
    part: T = connection.app.state.parts.by_type[kind]
    return part


def part(kind: type[T]) -> Any:
    """Return a dependency on the part of this type: `OrdersDep = Annotated[Orders, part(Orders)]`."""

    async def find(connection: HTTPConnection) -> T:
        return find_part(connection, kind)

    return Depends(find)
