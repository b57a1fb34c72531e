"""Whatever bytes a host sends, the byte machine neither breaks nor stays deaf for ever."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot.simulated import SimulatedRobot
from robot.simulated.base.commands import COMMANDS
from tests.plain_maps import plain_map

PASSIVE = 1
LONGEST_COMMAND = 2 + 2 * 255
ANSWER_S = 0.1
"""A byte at 300 baud takes a third of it."""
opcodes = st.sampled_from(sorted(COMMANDS)).map(lambda opcode: bytes((opcode,)))
chunks = st.lists(st.one_of(opcodes, st.binary(max_size=8)), max_size=30).map(b"".join)


@settings(max_examples=150, deadline=None)
@given(st.lists(chunks, max_size=5))
@pytest.mark.slow
def test_after_any_bytes_the_robot_can_be_started_again(lines):
    robot = SimulatedRobot(plain_map("test_track"), 0.0, "post1:post2", in_memory=True)
    port = robot.memory_port()
    for line in (b"\x80\x83", *lines):
        port.write(line)
        robot.step_until(robot.now + 0.05)
        port.baudrate = robot.body.interface.baud
        port.reset_input_buffer()
    robot.step_until(robot.now + 5.0)  # a reset may still be printing
    port.baudrate = robot.body.interface.baud
    robot.brc.low(True)
    robot.step_until(robot.now + 0.1)
    robot.brc.low(False)
    port.write(bytes(LONGEST_COMMAND))  # fills whatever command is half said
    robot.step_until(robot.now + 1.0)
    while robot.body.interface.has_more:  # long answers take their time on the line
        robot.step_until(robot.now + 1.0)
    port.baudrate = robot.body.interface.baud
    port.write(b"\x96\x00\x80\x8e\x23")
    robot.step_until(robot.now + ANSWER_S)
    port.reset_input_buffer()
    port.write(b"\x8e\x23")
    robot.step_until(robot.now + ANSWER_S)
    assert port.read(99) == bytes((PASSIVE,))
    robot.close()
