"""The texts of the demonstration's own page."""

import re

from demo.fleet.window import FILES

LANGUAGE = re.compile(r"^  (\w+): \{\n(.*?)^  \},", re.DOTALL | re.MULTILINE)
TEXT = re.compile(r"^    (\w+): \"(.*)\",$", re.MULTILINE)
GAP = re.compile(r"\{\w+\}")


def test_both_languages_say_the_same_with_the_same_gaps() -> None:
    source = (FILES / "texts.js").read_text(encoding="utf-8")
    gaps = {
        language: {key: sorted(GAP.findall(text)) for key, text in TEXT.findall(block)}
        for language, block in LANGUAGE.findall(source)
    }
    assert gaps.keys() == {"en", "fr"}
    assert len(gaps["en"]) > 10
    assert gaps["en"] == gaps["fr"]


def test_every_text_is_used() -> None:
    source, page = ((FILES / name).read_text(encoding="utf-8") for name in ("texts.js", "window.js"))
    computed = {"bay", "crossing", "corridor", "agrees", "moving", "differs"}
    assert {key for key, _ in TEXT.findall(source) if f'"{key}"' not in page} <= computed
