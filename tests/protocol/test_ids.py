from random import Random

from protocol.ids import ids_from, new_id, new_uuid


def some() -> list[str]:
    return [new_id(), new_uuid(), new_id()]


def test_no_two_are_alike() -> None:
    assert len({new_id() for _ in range(1000)}) == 1000
    assert len({new_uuid() for _ in range(1000)}) == 1000


def test_from_one_source_the_same_come_again_and_only_for_as_long_as_it_is_given() -> None:
    with ids_from(Random(7).randbytes):
        first = some()
    between = some()
    with ids_from(Random(7).randbytes):
        assert some() == first
    assert not set(between) & set(first)
