"""Headers as the standard library writes them, but the same one is read and folded once.

By the book that takes longer than everything else about a mail, and most headers are the same in one mail after the
other: the sender, the title of a notice, the address of a person with several orders.
"""

from email.policy import EmailPolicy
from functools import lru_cache
from typing import Any, Final

BY_THE_BOOK: Final = EmailPolicy(linesep="\r\n")
KEPT: Final = 256
MESSAGE_ID: Final = "Message-ID"


class RememberingPolicy(EmailPolicy):
    """Mails share header objects, which nothing changes: to set a header anew is to put another in its place."""

    def header_max_count(self, name: str) -> int | None:
        return _max_count(name)

    def header_store_parse(self, name: str, value: Any) -> tuple[str, Any]:
        # Ours, of letters that are harmless in a header, and another in each mail: there is nothing to read.
        return (name, value) if name == MESSAGE_ID else _read(name, value)

    def fold_binary(self, name: str, value: Any) -> bytes:
        if name == MESSAGE_ID and value.isascii():  # one word, and another in each mail: there is nothing to fold
            return f"{name}: {value}\r\n".encode("ascii")
        return _folded(name, value)


@lru_cache(KEPT)
def _max_count(name: str) -> int | None:
    return BY_THE_BOOK.header_max_count(name)


@lru_cache(KEPT)
def _read(name: str, value: Any) -> tuple[str, Any]:
    return BY_THE_BOOK.header_store_parse(name, value)


@lru_cache(KEPT)
def _folded(name: str, value: Any) -> bytes:
    return BY_THE_BOOK.fold_binary(name, value)


MAIL: Final = RememberingPolicy(linesep="\r\n")
"""Lines end as mail servers want them."""
