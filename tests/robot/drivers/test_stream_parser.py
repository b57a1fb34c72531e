"""Frames out of noise: no byte sequence makes a wrong state, and one lost byte costs one frame."""

import random
from struct import calcsize, pack

from hypothesis import assume, given
from hypothesis import strategies as st

from robot.drivers.create2 import open_interface as oi
from robot.drivers.create2.firmware_text import BatteryText, battery_text, firmware_version
from robot.drivers.create2.stream_parser import StreamParser

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


PADDING = bytes(61)
pieces = st.one_of(
    st.binary(max_size=80),
    st.sampled_from((b"\x13", b"\x13\x3a", b"\x13\x38", CHARGING.encode(), b"\r\n")),
    # The beginning of a frame that was cut off: the best of all false headers.
    st.tuples(st.integers(0, 60), st.integers(-99, -1)).map(lambda cut: frame(cut[1])[: cut[0]]),
)
noises = st.lists(pieces, max_size=4).map(b"".join)


def sound_frames(stream: bytes) -> int:
    """At how many places one begins. A cut one that what follows makes sound, as happens once in 256 times, is one:
    a checksum of one byte cannot tell."""
    layouts = (oi.FULL_STREAM, oi.WITHOUT_MODE)
    windows = ((layout, stream[at : at + layout.frame_length]) for at in range(len(stream)) for layout in layouts)
    return sum(
        window[:1] == b"\x13" and len(window) == layout.frame_length and sum(window) % 256 == 0
        and window[1] == len(window) - 3 and ids_in(layout, window) == layout.ids
        for layout, window in windows
    )  # fmt: skip


def ids_in(layout: oi.StreamLayout, frame: bytes) -> tuple[int, ...]:
    sizes = [1 + calcsize(oi.STREAMED[packet][0]) for packet in layout.ids]
    return tuple(frame[2 + sum(sizes[:n])] for n in range(len(sizes)))


@given(st.lists(noises, max_size=12), st.randoms(use_true_random=False))
def test_noise_between_frames_costs_no_frame_and_makes_none(between: list[bytes], cut: random.Random) -> None:
    stream = b"".join(noise + frame(number) for number, noise in enumerate(between)) + PADDING
    assume(sound_frames(stream) == len(between))
    parser, found, at = StreamParser(), [], 0
    while at < len(stream):
        size = cut.randint(1, 100)
        found += counts(parser.feed(stream[at : at + size]))
        at += size
    assert found == list(range(len(between)))


@given(st.lists(st.tuples(st.sampled_from(["whole", "lost", "changed"]), st.integers(0, 60), st.integers(1, 255))))
def test_damage_costs_at_most_the_frames_that_it_touches(damages: list[tuple[str, int, int]]) -> None:
    stream, whole = b"", []
    for number, (damage, at, bits) in enumerate(damages):
        data = bytearray(frame(number))
        if damage == "lost":
            del data[at]
        elif damage == "changed":
            data[at] ^= bits
        else:
            whole.append(number)
        stream += data
    assert counts(StreamParser().feed(stream + PADDING)) == whole


@given(st.sampled_from(sorted(oi.LARGEST)), st.integers(1, 120))
def test_a_value_that_no_base_says_is_not_believed_whatever_its_checksum(name: str, more: int) -> None:
    wrong = packed(oi.FULL_STREAM, **{name: oi.LARGEST[name] + more})
    parser = StreamParser()
    assert counts(parser.feed(wrong + frame(2))) == [2]
    assert parser.corrupt == 1


def test_a_stream_without_packet_35_is_understood_too() -> None:
    frames = StreamParser().feed(packed(oi.WITHOUT_MODE, left_count=7) + frame(8))
    assert counts(frames) == [7, 8]
    assert ["mode" in values for values in frames] == [False, True]


def test_the_version_of_the_firmware_is_in_its_boot_text() -> None:
    assert firmware_version("r3-robot/tags/release-stm32-3.7.7:6913 CLEAN") == "3.7.7"
    assert firmware_version("r3_robot/tags/release-3.4.2:5106 CLEAN") == "3.4.2"
    assert firmware_version("bootloader id: #x47135160") is None
