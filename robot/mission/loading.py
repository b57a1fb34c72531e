"""How mail came aboard: needed to bring it back."""

from protocol.parts import Part


class Loading(Part):
    """Where mail came aboard and by which code: None if no person was identified (the Spot button)."""

    post: str
    code_sha256: str | None = None
