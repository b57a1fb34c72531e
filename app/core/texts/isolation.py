"""Words that run from right to left within sentences that do not; `web/src/texts/texts.js` does the same."""

import re
from typing import Final

RIGHT_TO_LEFT: Final = re.compile("[\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc\U00010800-\U00010fff\U0001e800-\U0001efff]")
FIRST_STRONG_ISOLATE: Final = "\u2068"
POP_ISOLATE: Final = "\u2069"


def isolated(words: str) -> str:
    """Keep a Hebrew or Arabic name from turning round the time or the number that stands beside it."""
    return f"{FIRST_STRONG_ISOLATE}{words}{POP_ISOLATE}" if RIGHT_TO_LEFT.search(words) else words
