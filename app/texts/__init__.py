"""What people are told, in their language: one catalogue per language, which the pages share (`web/texts`)."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Final, get_args

from app.setting_kinds import Language
from app.settings import ROOT

LANGUAGES: Final[tuple[str, ...]] = get_args(Language)
FOLDER: Final = ROOT / "web" / "texts"


@cache
def catalogue(language: str) -> Mapping[str, str]:
    """All texts of a language; an unknown language reads English."""
    name = language if language in LANGUAGES else "en"
    texts: dict[str, str] = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    return texts


def text(language: str, key: str, facts: Mapping[str, str] | None = None) -> str:
    """One text with its gaps filled. KeyError for a text or a fact that is not there: never a text with holes."""
    return catalogue(language)[key].format_map(facts or {})
