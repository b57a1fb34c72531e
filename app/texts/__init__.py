"""What the service says to people outside its pages: one catalogue per language, all with the same keys."""

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Final

LANGUAGES: Final = ("en", "fr")
FOLDER = Path(__file__).parent


@cache
def catalogue(language: str) -> Mapping[str, str]:
    """All texts of a language; an unknown language reads English."""
    name = language if language in LANGUAGES else "en"
    texts: dict[str, str] = json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))
    return texts


def text(language: str, key: str, facts: Mapping[str, str] | None = None) -> str:
    """One text with its gaps filled. KeyError for a text or a fact that is not there: never a text with holes."""
    return catalogue(language)[key].format_map(facts or {})
