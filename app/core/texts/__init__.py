"""Texts for people, in their language: one catalogue per language, which the pages share (`web/src/texts`)."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Final, get_args

from app.core.setting_kinds import Language
from app.core.settings import ROOT
from app.core.texts.isolation import isolated
from protocol.one_line import one_line

LANGUAGES: Final[tuple[str, ...]] = get_args(Language)
FOLDER: Final = ROOT / "web" / "src" / "texts"


@cache
def catalogue(language: str) -> Mapping[str, str]:
    """Return all texts of a language; an unknown language reads English."""
    name = language if language in LANGUAGES else "en"
    texts: dict[str, str] = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    return texts


def text(language: str, key: str, facts: Mapping[str, str] | None = None) -> str:
    """One text with its gaps filled, each by one printable line: no fact writes paragraphs of its own into a mail.

    KeyError for a text or a fact that is not there: never a text with holes.
    """
    return catalogue(language)[key].format_map({name: isolated(one_line(fact)) for name, fact in (facts or {}).items()})
