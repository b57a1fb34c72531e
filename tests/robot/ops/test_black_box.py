"""The last minute of a robot: in memory without end, on the disk when it stopped, readable afterwards."""

import gzip
import threading
import tracemalloc
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from robot.core.errors import BlackBoxUnreadable
from robot.drive_loop import DriveLoop
from robot.drive_loop.black_box import KEPT_FILES, KEPT_ROWS, BlackBox, rows
from tests.own_process import in_own_process
from tests.robot.reflexes.moving import Moving

START = datetime(2026, 1, 5, 9, 0, tzinfo=UTC)
FRAME = bytes(range(61))
MOST_BYTES = 4_000_000


class Calendar:
    """A minute passes between two looks at it."""

    def __init__(self) -> None:
        self.looks = 0

    def __call__(self) -> datetime:
        self.looks += 1
        return START + timedelta(minutes=self.looks)


def files(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.glob("*"))


def test_a_robot_that_stopped_leaves_a_file_that_holds_why_and_how(moving: Moving, tmp_path: Path) -> None:
    box = BlackBox(tmp_path, Calendar())
    moving.base.listen_in(box.heard, box.sent)
    moving.loop = DriveLoop(moving.base, moving.sensor, moving.shape, moving.now, black_box=box)
    moving.sets_off()
    moving.robot.set_fault("cliff_left", True)
    moving.steps(1.5)
    box.close()
    (name,) = files(tmp_path)
    assert name == "20260105T090100.000000Z-cliff.jsonl.gz"
    header, *found = rows(tmp_path / name)
    assert header.kind == "black_box"
    assert header.data == {"at_utc": "2026-01-05T09:01:00+00:00", "fault": "cliff"}
    fault_s = next(row.at_s for row in found if row.kind == "faults" and row.data == ["cliff"])
    stops = [row for row in found if row.kind == "sent" and row.data == bytes((145, 0, 0, 0, 0))]
    assert any(0 <= row.at_s - fault_s <= 0.02 for row in stops), "the bytes that stopped the wheels"
    frames = [row for row in found if row.kind == "heard" and row.data[:1] == b"\x13"]
    assert len(frames) > 50
    assert found[-1].at_s - fault_s > 0.8, "it also holds how the robot came to stand"
    assert any(row.kind == "job" and row.data.endswith("rolls begins") for row in found)


@pytest.mark.nightly
def test_the_memory_it_takes_is_bounded_however_long_the_robot_runs() -> None:
    assert in_own_process(taken_by_much) < MOST_BYTES


def taken_by_much() -> int:
    """Bytes, after five times as many rows as are kept."""
    box = BlackBox()
    tracemalloc.start()
    before = tracemalloc.get_traced_memory()[0]
    for number in range(5 * KEPT_ROWS):
        box.heard(FRAME[:-1] + bytes((number % 256,)), number / 100)
    taken = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    return taken


def test_a_file_holds_the_last_minute_and_no_more(tmp_path: Path) -> None:
    box = BlackBox(tmp_path)
    for second in range(100):
        box.note("line", float(second), "101")
    file = box.write("on_demand")
    assert file is not None
    at = [row.at_s for row in rows(file) if row.kind == "line"]
    assert (at[0], at[-1]) == (39.0, 99.0)


def test_the_oldest_files_make_room(tmp_path: Path) -> None:
    box = BlackBox(tmp_path, Calendar())
    for _ in range(KEPT_FILES + 3):
        box.write("bump")
    kept = files(tmp_path)
    assert len(kept) == KEPT_FILES
    assert kept[0].startswith("20260105T0904")


def test_the_same_fault_again_within_the_minute_is_in_the_file_of_the_first(tmp_path: Path) -> None:
    box = BlackBox(tmp_path, Calendar())
    for at_s in (1.0, 20.0, 40.0, 70.0):
        box.write_at(at_s, "stall")
        box.write_what_is_due(at_s)
    box.close()
    assert len(files(tmp_path)) == 2


@pytest.mark.slow
def test_many_threads_note_while_it_is_written(tmp_path: Path) -> None:
    box, over = BlackBox(tmp_path), threading.Event()

    def notes() -> None:
        number = 0
        while not over.is_set():
            number += 1
            box.note("action", number / 1000, f"number {number}")

    threads = [threading.Thread(target=notes) for _ in range(2)]
    for thread in threads:
        thread.start()
    written = [box.write("on_demand")]
    over.set()
    for thread in threads:
        thread.join()
    assert all(file is not None and len(list(rows(file))) > 1 for file in written)


def test_a_file_that_cannot_be_written_does_not_end_the_writer(tmp_path: Path) -> None:
    class UnspeakableAtFirst:
        asked = 0

        def __str__(self) -> str:
            self.asked += 1
            if self.asked == 1:
                raise RuntimeError
            return "said"

    box = BlackBox(tmp_path)
    box.note("action", 0.0, UnspeakableAtFirst())
    for name in ("bump", "cliff"):
        box.write_at(0.0, name)
    box.write_what_is_due(0.0)
    box.close()
    assert [name.partition("-")[2] for name in files(tmp_path)] == ["cliff.jsonl.gz"]


def test_what_a_power_cut_left_half_written_goes_with_the_next_file(tmp_path: Path) -> None:
    (tmp_path / "20260105T090000.000000Z-bump.jsonl.part").write_bytes(b"half")
    BlackBox(tmp_path).write("on_demand")
    assert not list(tmp_path.glob("*.part"))


def test_a_disk_without_room_ends_nothing(tmp_path: Path) -> None:
    (tmp_path / "in the way").write_text("no folder")
    box = BlackBox(tmp_path / "in the way")
    box.write_at(1.0, "cliff")
    box.write_what_is_due(2.0)
    box.close()
    box.note("line", 3.0, "111")


def test_without_a_folder_nothing_is_written() -> None:
    assert BlackBox().write("on_demand") is None


@pytest.mark.parametrize(
    "content",
    [b"", b"no gzip at all", gzip.compress(b'{"kind": "line"}\n'), gzip.compress(b"x")],
    ids=["empty", "no gzip", "half a row", "no row"],  # compressed bytes hold the time of day
)
def test_a_file_that_is_no_black_box_is_refused_by_name(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "torn.jsonl.gz"
    file.write_bytes(content)
    with pytest.raises(BlackBoxUnreadable, match=r"torn.jsonl.gz, after line .: no black box can be read there"):
        list(rows(file))


def test_hand_over_codes_are_not_in_it(moving: Moving, tmp_path: Path) -> None:
    box = BlackBox(tmp_path)
    moving.loop = DriveLoop(moving.base, moving.sensor, moving.shape, moving.now, black_box=box)
    moving.robot.show_code("CM1:" + "a1" * 16, 5.0)
    moving.until(lambda: moving.loop.view.code is not None, 5.0)
    file = box.write("on_demand")
    assert file is not None
    assert b"CM1" not in gzip.decompress(file.read_bytes())
