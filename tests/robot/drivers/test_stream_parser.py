"""Frames out of noise: no byte sequence makes a wrong state, and one lost byte costs one frame."""

import random
from struct import pack

from hypothesis import given
from hypothesis import strategies as st

from robot.drivers import open_interface as oi
from robot.drivers.firmware_text import BatteryText, battery_text
from robot.drivers.stream_parser import StreamParser

CHARGING = "bat:   min 0  sec 4  mV 17506  mA 891  tenths-deg-C 291  mAH 2696  state 8  mode 7"


def frame(number: int) -> bytes:
    return packed(oi.FULL_STREAM, left_count=number)


def packed(layout: oi.StreamLayout, **values: int) -> bytes:
    """A sound frame of this layout; what is not given is 0."""
    body = b"".join(
        bytes((packet,)) + pack(">" + oi.STREAMED[packet][0], values.get(oi.STREAMED[packet][1], 0))
        for packet in layout.ids
    )
    head = bytes((19, len(body))) + body
    return head + bytes((-sum(head) & 0xFF,))


def counts(frames: list[dict[str, int]]) -> list[int]:
    return [values["left_count"] for values in frames]


def test_a_frame_is_61_bytes_as_in_the_fact_sheet():
    assert len(frame(1)) == oi.FULL_STREAM.frame_length == 61


def test_frames_arrive_whole_however_the_bytes_are_cut():
    stream = b"".join(frame(number) for number in range(30))
    cut = random.Random(1)
    parser, found, at = StreamParser(), [], 0
    while at < len(stream):
        size = cut.randint(1, 90)
        found += counts(parser.feed(stream[at : at + size]))
        at += size
    assert found == list(range(30))


def test_one_lost_byte_costs_one_frame():
    for lost in range(61):
        damaged = frame(1) + frame(2)[:lost] + frame(2)[lost + 1 :] + frame(3) + frame(4)
        assert counts(StreamParser().feed(damaged)) == [1, 3, 4], f"byte {lost} lost"


def test_a_flipped_bit_is_never_believed():
    for position in range(61):
        damaged = bytearray(frame(2))
        damaged[position] ^= 0x10
        assert counts(StreamParser().feed(frame(1) + bytes(damaged) + frame(3) + frame(4)))[::2][:1] == [1]
        assert 2 not in counts(StreamParser().feed(bytes(damaged) + frame(3)))


def test_a_header_byte_inside_the_data_is_no_header():
    assert counts(StreamParser().feed(frame(0x133A) + frame(19) + frame(3))) == [0x133A, 19, 3]


def test_text_between_frames_is_kept_apart_by_lines():
    parser = StreamParser()
    found = parser.feed(frame(1) + CHARGING.encode() + b"\r\n" + frame(2) + b"Soft re" + frame(3) + b"set!\n")
    assert counts(found) == [1, 2, 3]
    assert parser.take_lines() == [CHARGING, "Soft reset!"]
    assert parser.take_lines() == []


def test_the_battery_line_is_read_while_the_interface_is_off():
    assert battery_text(CHARGING) == BatteryText(17506, 891, 2696)
    assert battery_text("do-charging-full @ min 0") is None


@given(st.binary(max_size=400))
def test_no_noise_makes_it_fail_or_miss_the_next_two_frames(noise: bytes):
    parser = StreamParser()
    parser.feed(noise)
    assert counts(parser.feed(frame(5) + frame(6) + frame(7)))[-1] == 7
