"""Why orders wait that no robot has yet, in the sentences that pages know in each language."""

from typing import Final

from app.dispatch.choice import why_nobody_comes
from app.dispatch.open_work import OpenWork
from app.dispatch.planning.deciding import Decision
from app.dispatch.planning.why import Why, why_orders_wait

BUSY: Final = "Every robot is busy."
SAID: Final = {"next": BUSY, "turn": BUSY, "fetched": BUSY, "fetched_after": BUSY}
"""How many others come first changes with every order that is placed: it is not said."""


def sentences(work: OpenWork, decision: Decision | None, orders: list[str]) -> dict[str, list[str]]:
    """Each sentence with the orders that it is about."""
    whys = why_orders_wait(decision) if decision is not None else {}
    told: dict[str, list[str]] = {}
    for order in orders:
        told.setdefault(_sentence(work, whys.get(order)), []).append(order)
    return told


def _sentence(work: OpenWork, why: Why | None) -> str:
    if why is None or why.code == "no_robot" or not work.connected:
        return why_nobody_comes((), work.connected)
    if why.code == "robot_absent" and any(work.robots[name].is_there for name in why.robots if name in work.robots):
        return BUSY
    if why.code == "robot_paused" and not any(work.robots[name].gives_away for name in why.robots):
        return BUSY  # each has just something to do in which it must not be disturbed
    return SAID.get(why.code) or why.sentence(lambda at_s: f"{at_s:.0f} s")
