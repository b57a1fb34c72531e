"""Errors of a scenario before it runs."""


class ScenarioError(Exception):
    """A scenario that cannot be used: where it stands, what is wrong, and what to do about it."""

    def __init__(self, source: str, key: str, message: str, way_out: str = "") -> None:
        self.source, self.key, self.message, self.way_out = source, key, message, way_out
        super().__init__(f"{source}: {key}: {message}. {way_out}".strip())


class RecordingError(Exception):
    """A recording that cannot be read or written: it names the file and what is wrong with it."""
