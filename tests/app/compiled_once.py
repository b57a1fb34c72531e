"""Statements compiled once for all tests: each test has an engine of its own, which would compile all of them anew."""

from typing import Any

from sqlalchemy import Connection, Engine, event


class CompiledOnce(dict[Any, Any]):
    """A cache of SQLAlchemy's compiled statements by dialect and driver: each engine has a dialect of its own."""

    def get(self, key: Any, default: Any = None) -> Any:
        return super().get(_by_driver(key), default)

    def __setitem__(self, key: Any, compiled: Any) -> None:
        super().__setitem__(_by_driver(key), compiled)


def _by_driver(key: Any) -> tuple[Any, ...]:
    dialect, *rest = key
    return dialect.name, dialect.driver, *rest


def compile_once() -> None:
    """For every engine of this process."""
    compiled = CompiledOnce()

    @event.listens_for(Engine, "engine_connect")
    def share(connection: Connection) -> None:
        connection.execution_options(compiled_cache=compiled)
