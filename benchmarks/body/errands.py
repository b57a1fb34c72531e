"""Letters one after the other for a robot that works alone, and the people at both ends of each."""

from collections.abc import Iterator
from hashlib import sha256
from random import Random

from protocol.clock import Clock
from protocol.parts import Purpose, Stop, StopAction
from protocol.to_robot import Mission, Verifier, Verifiers
from robot.ops.assembly import Parts

POSTS = ("post1", "post2", "post3", "post4")
ACTIONS = {Purpose.LOAD: StopAction.LOAD, Purpose.RECEIVE: StopAction.RECEIVE}
SHOWN_FOR_S = 4.0


class Errands:
    """`look` is a watcher of the daemon: it plays the people after each tick of the mind."""

    def __init__(self, parts: Parts, clock: Clock, seed: int, routes: Iterator[tuple[str, str]] | None = None) -> None:
        """`routes` are the posts of sender and recipient; without them, any two, for ever."""
        assert parts.robot is not None
        self._robot, self._duties, self._actions = parts.robot, parts.mind.hands.missions, parts.mind.actions
        self._clock, self._random = clock, Random(f"{seed}/errands")
        self._routes = _any_two(self._random) if routes is None else routes
        self._codes: dict[str, str] = {}
        self._letters = 0

    @property
    def delivered(self) -> int:
        return self._letters - (self._duties.held.mission is not None)

    def look(self, _: float) -> None:
        if self._duties.held.mission is None and (route := next(self._routes, None)):
            self._give_letter(route)
        waited_for = next((one for one in self._actions.under_way if one.startswith("wait_handover(")), None)
        if waited_for and not self._duties.custody.handing_over and self._robot.camera.shown is None:
            purpose = waited_for.removeprefix("wait_handover(").split(",")[0]
            self._robot.show_code(self._codes[purpose], SHOWN_FOR_S)

    def _give_letter(self, route: tuple[str, str]) -> None:
        self._letters += 1
        number = self._letters
        places = dict(zip(ACTIONS, route, strict=True))
        self._codes = {purpose.value: f"CM1:{self._random.randbytes(16).hex()}" for purpose in ACTIONS}
        order = f"o{number}"
        self._duties.memory.keep_verifiers(
            Verifiers(verifiers=tuple(self._verifier(order, purpose) for purpose in ACTIONS)), self._clock.utc()
        )
        stops = tuple(
            Stop(id=f"s{number}{purpose}", post=post, action=ACTIONS[purpose], order_id=order)
            for purpose, post in places.items()
        )
        self._duties.give(Mission(id=f"m{number}", update=1, stops=stops))

    def _verifier(self, order: str, purpose: Purpose) -> Verifier:
        return Verifier(
            order_id=order,
            purpose=purpose,
            sha256=sha256(self._codes[purpose.value].encode()).hexdigest(),
            expires_at=self._clock.utc().replace(year=2999),
        )


def _any_two(random: Random) -> Iterator[tuple[str, str]]:
    while True:
        from_post, to_post = random.sample(POSTS, 2)
        yield from_post, to_post
