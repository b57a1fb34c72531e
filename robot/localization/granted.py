"""Which of the corridors that a robot holds lie before it."""

from collections.abc import Iterable, Sequence

from protocol.parts import Leg


def behind(held: Sequence[Leg], here: str, crossed: Leg | None = None) -> tuple[Leg, ...]:
    """Return those that it cannot come to any more by corridors that it holds: a robot that waits for them waits in
    vain. `crossed`: it has just come through that one."""
    left = [leg for leg in held if leg != crossed]
    ahead = _reached(left, here)
    return tuple(leg for leg in held if leg == crossed or leg.from_post not in ahead)


def _reached(held: Iterable[Leg], here: str) -> set[str]:
    posts, found = {here}, {here}
    while found:
        found = {leg.to_post for leg in held if leg.from_post in found} - posts
        posts |= found
    return posts
