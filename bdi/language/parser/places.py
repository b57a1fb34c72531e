"""Places in a text."""

from bisect import bisect_right

from bdi.language.errors import Place

LONGEST_LINE = 300  # a longer one is not shown with an error


class Places:
    """The lines of one text."""

    __slots__ = ("_starts", "source", "text")

    def __init__(self, text: str, source: str) -> None:
        self.text = text
        self.source = source
        self._starts: list[int] = []

    def at(self, offset: int) -> Place:
        """Line and column of the character at this offset, both from 1."""
        if not self._starts:
            self._starts = [0, *(place + 1 for place, char in enumerate(self.text) if char == "\n")]
        line = bisect_right(self._starts, offset)
        start = self._starts[line - 1]
        end = self._starts[line] - 1 if line < len(self._starts) else len(self.text)
        shown = self.text[start:end] if end - start <= LONGEST_LINE else ""
        return Place(self.source, line, offset - start + 1, shown)

    def end_of(self, offset: int) -> Place:
        """The place right after the last visible character before the offset."""
        return self.at(len(self.text[:offset].rstrip()))

    def is_first_on_line(self, offset: int) -> bool:
        return not self.text[self.text.rfind("\n", 0, offset) + 1 : offset].strip()
