"""However many pages are open, what happens is put into words once; and never if nobody is there to read it."""

from collections.abc import ItemsView
from datetime import UTC, datetime

from app.live.feed import Happening, LocalFeed
from app.people.service import make_person

AT = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)


class Read(dict[str, int]):
    """Facts that know how often they were read."""

    times = 0

    def items(self) -> ItemsView[str, int]:
        self.times += 1
        return super().items()


def test_what_happens_is_encoded_once_for_all_listeners() -> None:
    feed, unheard, heard = LocalFeed(), Read(number=1), Read(number=2)
    feed.publish(Happening("robot", unheard))
    people = [make_person(f"p{number}@campus.example", "en", AT) for number in range(3)]
    with feed.listening(people[0]) as first, feed.listening(people[1]) as second, feed.listening(people[2]) as third:
        feed.publish(Happening("robot", heard))
        pieces = [queue.get_nowait() for queue in (first, second, third)]
    wires = [piece.wire for piece in pieces if piece is not None]
    assert wires == [f'event: robot\ndata: {{"number": 2}}\nid: {feed.last_id}\n\n'.encode()] * 3
    assert (unheard.times, heard.times) == (0, 1)
