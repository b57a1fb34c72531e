"""One printable line: no line break, no control character, no mark that turns the direction of what follows."""

import re
from typing import Final

BREAKS: Final = r"\t-\r\x1c-\x1f\x85\u2028\u2029"
"""What begins a new line, column or paragraph."""

CONTROLS: Final = r"\x00-\x08\x0e-\x1b\x7f-\x84\x86-\x9f"
MARKS: Final = r"\xad\u061c\u180e\u200b\u200e\u200f\u202a-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb"
"""Format characters (Cf), which are invisible. Not the two joiners: Persian and the scripts of India need them."""

ONE_LINE: Final = rf"^[^{BREAKS}{CONTROLS}{MARKS}]*$"
"""For Python's, Rust's (pydantic) and ECMA's (JSON Schema) regular expressions alike."""

_UNPRINTABLE: Final = re.compile(f"[{BREAKS}{CONTROLS}{MARKS}]")
_BREAKS: Final = re.compile(f"[{BREAKS}]+")
_NOTHING: Final = re.compile(f"[{CONTROLS}{MARKS}]+")


def one_line(text: str) -> str:
    """The text as one printable line: a break becomes a space, other invisible characters nothing."""
    return _NOTHING.sub("", _BREAKS.sub(" ", text))


def escaped(text: str) -> str:
    """The text as one printable line from which nothing is missing: a line break reads `\\n`."""
    return _UNPRINTABLE.sub(lambda found: found[0].encode("unicode_escape").decode(), text)
