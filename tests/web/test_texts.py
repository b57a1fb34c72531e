"""The words of the pages: one catalogue per language."""

import itertools
import json
import re
from pathlib import Path

from app.core.text_lines import LONGEST_TEXT

WEB = Path(__file__).parents[2] / "web"
CATALOGUES = {
    path.stem: json.loads(path.read_text(encoding="utf-8")) for path in sorted((WEB / "src/texts").glob("*.json"))
}
SCRIPTS = sorted([*WEB.glob("src/*/*.js"), *WEB.glob("public/*.js")])
# t("key"), hasText("key"), and t(`prefix.${…}`), whose keys begin with the prefix
WHOLE_KEY = re.compile(r'"([a-z_]+(?:\.[a-z_0-9]+)+)"')
KEY_PREFIX = re.compile(r"`([a-z_]+\.(?:[a-z_]+\.)*)\$\{")
PREFIXES_BY_NAME = {
    "state.": "sentence",
    "next.": "sentence",
    "nav.unread.": "counted",
    # the same catalogues serve what is mailed and told (tests/app/notifications)
    "email.": "the service",
    "notice.": "the service",
    "why.": "reasonText",
    "alarm.of.": "alarmText",
}


def test_all_languages_have_the_same_keys():
    assert set(CATALOGUES) == {"en", "fr"}
    assert list(CATALOGUES["en"]) == list(CATALOGUES["fr"])


def test_texts_and_fields_allow_what_the_service_does():
    for language, field in itertools.product(CATALOGUES, ("description", "reason")):
        assert re.findall(r"\d+", CATALOGUES[language][f"error.malformed.{field}"]) == [str(LONGEST_TEXT)]
    code = "\n".join(path.read_text(encoding="utf-8") for path in SCRIPTS)
    fields = re.findall(r'name="description"[^>]*?maxlength="(\d+)"', code)
    assert len(fields) == 2
    assert {*fields, *re.findall(r"LONGEST_REASON = (\d+)", code)} == {str(LONGEST_TEXT)}


def test_a_text_names_the_same_values_in_all_languages():
    english, french = CATALOGUES["en"], CATALOGUES["fr"]
    assert [key for key in english if values_in(english[key]) != values_in(french[key])] == []
    assert [key for key in english if not (english[key].strip() and french[key].strip())] == []


def values_in(text: str) -> set[str]:
    return set(re.findall(r"\{\w+\}", text))


def test_every_text_is_used_and_every_text_used_is_there():
    code = "\n".join(path.read_text(encoding="utf-8") for path in SCRIPTS)
    families = {key.split(".")[0] for key in CATALOGUES["en"]}
    named = {key for key in WHOLE_KEY.findall(code) if key.split(".")[0] in families}
    named = {key for key in named if not key.endswith((".js", ".json"))} - set(PREFIXES_BY_NAME)
    prefixes = {*KEY_PREFIX.findall(code), *PREFIXES_BY_NAME}
    missing = {key for key in named if key not in CATALOGUES["en"] and f"{key}.other" not in CATALOGUES["en"]}
    assert missing == set()
    assert [p for p in prefixes if not any(key.startswith(p) for key in CATALOGUES["en"])] == []
    whole = {key: key.removesuffix(".one").removesuffix(".other") for key in CATALOGUES["en"]}
    unused = [key for key in whole if not named & {key, whole[key]} and not key.startswith(tuple(prefixes))]
    assert unused == []
