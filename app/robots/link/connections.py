"""Open connections: one robot, one socket. In memory, since a socket does not outlive its process either."""

from collections.abc import Collection
from typing import Protocol

from protocol.to_robot import Watch


class Seat(Protocol):
    """A robot's open connection, as others see it. Neither call waits."""

    journal: str
    understands: Collection[str]

    def wake(self) -> None:
        """Something new is in the outbox."""
        ...

    def watch(self, watch: Watch) -> bool:
        """This robot is watched; False if it does not know what that is."""
        ...

    def give_way(self) -> None:
        """Another connection has taken this one's place: say so and close."""
        ...


class Connections:
    """The seats by the names of the robots."""

    def __init__(self) -> None:
        self._seats: dict[str, Seat] = {}

    def take(self, robot: str, seat: Seat) -> Seat | None:
        """Seat a new connection; returns the one that has to give way, which is told so."""
        before = self._seats.get(robot)
        self._seats[robot] = seat
        if before is not None:
            before.give_way()
        return before

    def leave(self, robot: str, seat: Seat) -> bool:
        """A connection has ended; False if another one had its seat already, so that the robot is not gone."""
        if self._seats.get(robot) is not seat:
            return False
        del self._seats[robot]
        return True

    def is_seated(self, robot: str) -> bool:
        """Tell if this robot is connected now."""
        return robot in self._seats

    def understands(self, robot: str, word: str) -> bool:
        """Tell if this robot is connected now, and has named this message among those that it knows."""
        seat = self._seats.get(robot)
        return seat is not None and word in seat.understands

    def wake(self, robot: str) -> None:
        """Something new is in the outbox of this robot, connected or not."""
        if seat := self._seats.get(robot):
            seat.wake()

    def watch(self, robot: str, watch: Watch) -> bool:
        """This robot is watched; False if it is not connected, or does not know what that is."""
        seat = self._seats.get(robot)
        return seat is not None and seat.watch(watch)
