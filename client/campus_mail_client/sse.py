"""Server-sent events, as the HTML standard has them: lines become events."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class SentEvent:
    """One event of the stream; `id` is where to resume from."""

    event: str
    data: str
    id: str


@dataclass
class EventReader:
    """Takes lines, gives events. `last_id` is what Last-Event-ID says on the next connection."""

    last_id: str = ""
    retry_s: float = 1.0
    _fields: dict[str, str] = field(default_factory=dict)

    def take(self, line: str) -> SentEvent | None:
        """One line without its end; an event, if the line ends one."""
        if not line:
            return self._end()
        name, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if name == "data" and "data" in self._fields:
            self._fields["data"] += "\n" + value
        elif name == "retry" and value.isdecimal():
            self.retry_s = int(value) / 1000
        elif name in {"event", "data", "id"}:
            self._fields[name] = value
        return None

    def _end(self) -> SentEvent | None:
        fields, self._fields = self._fields, {}
        self.last_id = fields.get("id", self.last_id)
        if "data" not in fields:
            return None
        return SentEvent(fields.get("event", "message"), fields["data"], self.last_id)

    def cut(self) -> None:
        """The connection broke: what was begun is not an event, and will be sent again."""
        self._fields = {}
