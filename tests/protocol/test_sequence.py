"""Whatever is lost, repeated or comes late: every durable message is taken once, and in order."""

from hypothesis import given
from hypothesis import strategies as st

from protocol.parts import Received
from protocol.sequence import Reception, reception, resume

JOURNAL = "outbox"


def test_the_next_one_is_new_a_lower_one_repeated_a_higher_one_a_gap() -> None:
    received = Received(journal=JOURNAL, seq=4)
    judged = [reception(received, JOURNAL, seq) for seq in (1, 4, 5, 6)]
    assert judged == [Reception.REPEATED, Reception.REPEATED, Reception.NEW, Reception.GAP]
    assert reception(received, "another", 5) is Reception.GAP


def test_a_journal_that_was_never_seen_begins_where_its_sender_can_begin() -> None:
    assert resume(Received(), JOURNAL, 1).received == Received(journal=JOURNAL, seq=0)
    resumption = resume(Received(journal="older", seq=99), JOURNAL, 41)
    assert (resumption.received, resumption.lost) == (Received(journal=JOURNAL, seq=40), 0)


def test_what_can_never_come_again_is_counted_and_skipped() -> None:
    resumption = resume(Received(journal=JOURNAL, seq=10), JOURNAL, 14)
    assert (resumption.received.seq, resumption.lost) == (13, 3)
    assert resume(Received(journal=JOURNAL, seq=10), JOURNAL, 11).lost == 0
    assert resume(Received(journal=JOURNAL, seq=10), JOURNAL, 3).received.seq == 10


@given(
    count=st.integers(1, 12),
    cuts=st.lists(st.tuples(st.integers(0, 12), st.booleans()), max_size=12),
)
def test_over_a_line_that_breaks_at_any_place_each_message_is_taken_once_and_in_order(
    count: int, cuts: list[tuple[int, bool]]
) -> None:
    """Each connection carries some messages from the backlog before it breaks; its acknowledgement may be lost."""
    outbox, taken, received = list(range(1, count + 1)), list[int](), Received()
    for carried, ack_arrives in [*cuts, (count, True)]:
        received = resume(received, JOURNAL, outbox[0] if outbox else count + 1).received
        for seq in outbox[:carried]:
            judged = reception(received, JOURNAL, seq)
            assert judged is not Reception.GAP
            if judged is Reception.NEW:
                taken.append(seq)
                received = Received(journal=JOURNAL, seq=seq)
        if ack_arrives:
            outbox = [seq for seq in outbox if seq > received.seq]
    assert taken == list(range(1, count + 1))
    assert outbox == []
