"""The verdict on a scenario: what became of each letter, by the truth, and whether that is what was expected."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum

from protocol.parts import Purpose
from robot.scenarios.actors.mail import WITH_RECIPIENT, WITH_SENDER, Letter
from robot.scenarios.actors.stand_in import StandIn, Told
from robot.scenarios.scenario import Expectation

SETTLES_S = 5.0
"""A person who hears a tune reaches into the box; the robot's receipt may be a moment earlier."""


NOTICES = frozenset(("marker_unread", "foreign_marker", "link_loss", "clock_jump", "disk_low"))
"""What is told of the world, and says of no mail that it will not arrive."""


class Fate(StrEnum):
    """The outcome of a letter."""

    DELIVERED = "delivered"
    """The recipient has it, and the robot said so."""
    HANDED_OVER = "handed_over"
    """It is where the robot says, and a person knows: the sender has it (still or again), or it is aboard and told."""
    LOST = "lost"
    """The service was not told that it will not arrive, or it is not where the robot says."""
    FALSE = "false"
    """A robot claimed what was not so."""


@dataclass(frozen=True)
class Verdict:
    """One letter. `why` says what the fate was seen from."""

    order: str
    fate: Fate
    why: str


@dataclass
class Ending:
    """Everything that is judged."""

    verdicts: list[Verdict]
    violations: list[str]
    bumps: int
    searches: int
    home: bool
    posts: list[str]
    told: list[Told] = field(default_factory=list)


def verdict(letter: Letter, service: StandIn) -> Verdict:
    """By what people did with the mail, and by what the service was told."""
    lies = false_claims(letter)
    if lies:
        return Verdict(letter.order.id, Fate.FALSE, lies[0])
    said_received = any(receipt.purpose is not Purpose.LOAD for receipt in letter.receipts)
    match letter.place:
        case place if place == WITH_RECIPIENT:
            fate = Fate.DELIVERED if said_received else Fate.LOST
            return Verdict(
                letter.order.id, fate, "" if said_received else "the recipient has it, but it was not reported"
            )
        case place if place == WITH_SENDER:
            return _with_sender(letter, service, said_received)
    return _aboard(letter, service)


def _with_sender(letter: Letter, service: StandIn, said_received: bool) -> Verdict:
    if letter.moved:
        fate = Fate.HANDED_OVER if said_received else Fate.LOST
        return Verdict(
            letter.order.id, fate, "returned to the sender" + ("" if said_received else ", but it was not reported")
        )
    if letter.gave_up:
        return Verdict(letter.order.id, Fate.HANDED_OVER, f"never loaded: {letter.gave_up[0]}")
    if letter.cancelled or letter.recalled:
        return Verdict(letter.order.id, Fate.HANDED_OVER, "cancelled before it was loaded")
    return _told_of_trouble(letter, service, letter.robot, "never loaded")


def _aboard(letter: Letter, service: StandIn) -> Verdict:
    snapshot = service.sessions[letter.place].snapshot
    if snapshot is None or letter.order.id not in snapshot.cargo:
        return Verdict(letter.order.id, Fate.LOST, f"it is in {letter.place}, which does not say so")
    if letter.gave_up:
        return Verdict(letter.order.id, Fate.HANDED_OVER, f"aboard {letter.place}: {letter.gave_up[-1]}")
    return _told_of_trouble(letter, service, letter.place, f"aboard {letter.place}")


def _told_of_trouble(letter: Letter, service: StandIn, robot: str | None, where: str) -> Verdict:
    """A robot that cannot go on and says why has handed the matter to a person."""
    faults = service.sessions[robot].faults.keys() - NOTICES if robot else set()
    if faults:
        return Verdict(letter.order.id, Fate.HANDED_OVER, f"{where}; told: {', '.join(sorted(faults))}")
    return Verdict(letter.order.id, Fate.LOST, f"{where}, and it was not reported")


def false_claims(letter: Letter) -> list[str]:
    """Receipts that are not what people did."""
    found = []
    for receipt in letter.receipts:
        before = {place for at_s, place in letter.moved if at_s <= receipt.at_s + SETTLES_S}
        if receipt.purpose is Purpose.LOAD and receipt.robot not in before:
            found.append(f"{receipt.robot} said loaded at {receipt.at_s:.1f} s, and no mail had been put in")
        if receipt.purpose is not Purpose.LOAD and not before & {WITH_RECIPIENT, WITH_SENDER}:
            found.append(f"{receipt.robot} said received at {receipt.at_s:.1f} s, and no mail had been taken")
    return found


def shortfalls(ending: Ending, expected: Expectation) -> list[str]:
    """Return unmet expectations, in sentences; none when all holds."""
    return [*_of_mail(ending, expected), *_of_driving(ending, expected), *ending.violations]


def _of_mail(ending: Ending, expected: Expectation) -> Iterable[str]:
    orders = [one.order for one in ending.verdicts]
    delivered = expected.delivered
    if delivered is None:
        delivered = tuple(order for order in orders if order not in expected.handed_over)
    for one in ending.verdicts:
        wanted = {Fate.DELIVERED} if one.order in delivered else {Fate.HANDED_OVER}
        if one.order not in delivered and one.order not in expected.handed_over:
            wanted = {Fate.DELIVERED, Fate.HANDED_OVER}
        if one.fate not in wanted:
            yield f"order {one.order} was to be {min(wanted)}, and is {one.fate}: {one.why}"


def _of_driving(ending: Ending, expected: Expectation) -> Iterable[str]:
    if expected.bumps_at_most is not None and ending.bumps > expected.bumps_at_most:
        yield f"{ending.bumps} bumps, at most {expected.bumps_at_most} were expected"
    if expected.searches_at_most is not None and ending.searches > expected.searches_at_most:
        yield f"the line was looked for {ending.searches} times, at most {expected.searches_at_most} were expected"
    if expected.home and not ending.home:
        yield "not every robot is in a dock"
    for wanted in expected.told:
        if not any(one.text.startswith(wanted) for one in ending.told):
            yield f"{wanted!r} was not reported"
    if expected.posts is not None and not _in_order(expected.posts, ending.posts):
        yield f"the way went over {', '.join(ending.posts)}, not {', '.join(expected.posts)}"


def _in_order(wanted: Iterable[str], seen: Iterable[str]) -> bool:
    left = iter(seen)
    return all(post in left for post in wanted)
