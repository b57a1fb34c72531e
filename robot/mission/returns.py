"""Bringing mail back: the mission that a robot gives itself when its mail was not taken, or when it is recalled."""

from collections.abc import Iterable, Mapping
from typing import Final

from protocol.ids import new_id
from protocol.parts import Stop, StopAction
from protocol.to_robot import Mission
from robot.mission.loading import Loading

PREFIX: Final = "return-"
WAIT_LIMIT_S: Final = 600.0


def return_mission(
    cargo: Iterable[str], loadings: Mapping[str, Loading], mailroom: str | None, before: Mission | None
) -> Mission | None:
    """Take each item to the mailroom if there is one, else to where it came aboard; None if that is unknown.

    One stop for each order, those of one post together; people get as long as the mission before gave them.
    """
    places = {order: mailroom or (loadings[order].post if order in loadings else None) for order in cargo}
    limits = {stop.order_id: stop.wait_limit_s for stop in (before.stops if before else ())}
    stops = [
        Stop(
            id=f"{PREFIX}{order}"[:64],
            post=post,
            action=StopAction.RETURN,
            order_id=order,
            wait_limit_s=limits.get(order, WAIT_LIMIT_S),
        )
        for order, post in places.items()
        if post
    ]
    posts = list(dict.fromkeys(stop.post for stop in stops))
    stops.sort(key=lambda stop: posts.index(stop.post))
    return Mission(id=PREFIX + new_id(), update=1, stops=tuple(stops)) if stops else None


def is_own(mission: Mission) -> bool:
    """Return whether the robot gave it to itself."""
    return mission.id.startswith(PREFIX)
