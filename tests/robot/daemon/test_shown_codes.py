"""A code that the whole robot has read proves its hand-over, and is kept nowhere."""

import gzip
from base64 import b64encode

import pytest

from protocol.parts import Purpose
from protocol.proofs import ShownCode
from protocol.to_server import Event, HandoverReceipt
from robot.drive_loop.black_box import BlackBox
from tests.robot.daemon.simulated_run import CODES, SimulatedRun


@pytest.mark.nightly
def test_receipts_are_proved_by_what_was_shown_and_nothing_of_it_is_written_down(
    run: SimulatedRun, capfd: pytest.CaptureFixture[str]
) -> None:
    run.given_a_letter()
    for purpose in (Purpose.LOAD, Purpose.RECEIVE):
        run.until(lambda: run.waits_for(f"wait_handover({purpose}"))  # noqa: B023  # looked at before the next
        run.shows(purpose)
        run.until(lambda: not run.waits_for(f"wait_handover({purpose}"), 10)  # noqa: B023
    messages = [kept.message for kept in run.missions.outbox.pending(limit=1000)]
    happened = [one.happened for one in messages if isinstance(one, Event)]
    receipts = [one for one in happened if isinstance(one, HandoverReceipt)]
    assert [one.number for one in receipts] == [1, 2]
    for receipt in receipts:
        assert receipt.proof == receipt.proved_with(ShownCode.of(CODES[receipt.purpose]).key)

    black_box = getattr(run.mind.note, "__self__", None)
    assert isinstance(black_box, BlackBox)
    written = black_box.write("on_demand")
    assert written
    assert "wait_handover" in gzip.decompress(written.read_bytes()).decode(), "the hand-overs are in it"
    files = [path for path in run.settings.data.rglob("*") if path.is_file()]
    assert {"robot.db"} <= {path.name for path in files}
    kept = b"".join(gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes() for path in files)
    said = "".join(capfd.readouterr()).encode() + kept
    for text in CODES.values():
        shown = ShownCode.of(text)
        assert shown.sha256.encode() in said, "what it is known by is there"
        for secret in (text.encode(), text[4:].encode(), bytes.fromhex(text[4:]), shown.key, shown.key.hex().encode()):
            assert secret not in said
            assert b64encode(secret) not in said
    assert shown.key.hex() not in repr(shown)
