"""The client follows the service: it is what its document makes, and nothing is left out."""

import ast
import importlib.util
import inspect
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from campus_mail_client import AsyncCampusMail, CampusMail

CLIENT = Path(__file__).parents[2] / "client"


def _load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec
    assert spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def maker() -> ModuleType:
    return _load(CLIENT / "make_client.py")


@pytest.fixture(scope="module")
def openapi(maker: ModuleType) -> Any:
    return maker.document()


def test_the_client_is_what_the_document_makes(maker: ModuleType, openapi: Any) -> None:
    for name, text in maker.made_files(openapi).items():
        assert (maker.PACKAGE / name).read_text() == text, f"{name}: run make client"


def test_every_operation_is_a_method_of_both_clients(maker: ModuleType, openapi: Any) -> None:
    named = {operation["operationId"] for _, _, operation in maker._for_programs(openapi)} - maker.BY_HAND
    assert len(named) > 25
    for client, is_awaited in ((AsyncCampusMail, True), (CampusMail, False)):
        for name in named:
            assert inspect.iscoroutinefunction(getattr(client, name)) == is_awaited, name


def test_the_client_needs_nothing_of_the_service() -> None:
    for path in (CLIENT / "campus_mail_client").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not {name.partition(".")[0] for name in names} & {"app", "protocol", "robot", "maps", "bdi"}, path
