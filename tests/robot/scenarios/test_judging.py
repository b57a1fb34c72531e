"""The judge goes by what people did with the mail; what robots say is only compared with it."""

from itertools import pairwise

import pytest

from maps import builtin_map
from protocol.clock import SteppedClock
from protocol.parts import Activity, Battery, Leg, Position, Purpose
from protocol.to_server import Snapshot
from robot.scenarios.actors.interlocking import Claimed, Interlocking
from robot.scenarios.actors.mail import WITH_RECIPIENT, WITH_SENDER, Letter, Receipt, letters_of
from robot.scenarios.actors.stand_in import StandIn
from robot.scenarios.judging import Ending, Fate, shortfalls, verdict
from robot.scenarios.scenario import Expectation, OrderRow

ORDER = OrderRow.model_validate({"id": "o1", "from": "post1", "to": "post4"})


@pytest.fixture
def letter() -> Letter:
    letter = letters_of((ORDER,), seed=1)["o1"]
    letter.robot = "r1"
    return letter


@pytest.fixture
def service(letter) -> StandIn:
    return StandIn(builtin_map("test_track"), SteppedClock(), {"o1": letter}, {"r1": "post5"})


def says_aboard(service: StandIn, *cargo: str) -> None:
    battery = Battery(ratio=0.5)
    snapshot = Snapshot(position=Position(), activity=Activity.IDLE, battery=battery, cargo=cargo)
    service.sessions["r1"].snapshot = snapshot


def loaded(letter: Letter) -> None:
    letter.put("r1", 10.0)
    letter.receipts.append(Receipt(10.2, "r1", Purpose.LOAD, "post1"))


def test_mail_that_the_recipient_has_and_the_robot_told_of_is_delivered(letter, service):
    loaded(letter)
    letter.put(WITH_RECIPIENT, 60.0)
    letter.receipts.append(Receipt(59.9, "r1", Purpose.RECEIVE, "post4"))
    assert verdict(letter, service).fate is Fate.DELIVERED


def test_a_delivery_that_nobody_took_is_a_false_claim(letter, service):
    loaded(letter)
    letter.receipts.append(Receipt(60.0, "r1", Purpose.RECEIVE, "post4"))
    found = verdict(letter, service)
    assert found.fate is Fate.FALSE
    assert "no mail had been taken" in found.why


def test_a_loading_that_nobody_did_is_a_false_claim_even_if_all_ends_well(letter, service):
    letter.receipts.append(Receipt(2.0, "r1", Purpose.LOAD, "post1"))
    letter.put("r1", 30.0)
    letter.put(WITH_RECIPIENT, 60.0)
    letter.receipts.append(Receipt(60.0, "r1", Purpose.RECEIVE, "post4"))
    assert verdict(letter, service).fate is Fate.FALSE


def test_mail_in_a_robot_that_does_not_say_so_is_lost(letter, service):
    loaded(letter)
    says_aboard(service)
    assert verdict(letter, service).fate is Fate.LOST


def test_mail_aboard_is_handed_to_a_person_only_if_somebody_was_told(letter, service):
    loaded(letter)
    says_aboard(service, "o1")
    assert verdict(letter, service).fate is Fate.LOST
    letter.gave_up.append("no_one_came")
    assert verdict(letter, service).fate is Fate.HANDED_OVER


def test_mail_that_was_brought_back_is_handed_over(letter, service):
    loaded(letter)
    letter.put(WITH_SENDER, 90.0)
    letter.receipts.append(Receipt(90.0, "r1", Purpose.RETURN, "post1"))
    assert verdict(letter, service).fate is Fate.HANDED_OVER


def test_a_letter_that_nobody_fetched_and_nobody_spoke_of_is_lost(letter, service):
    assert verdict(letter, service).fate is Fate.LOST
    service.sessions["r1"].faults["way_blocked"] = "a person stands in the way"
    assert verdict(letter, service).fate is Fate.HANDED_OVER


def test_what_was_expected_and_is_not_so_is_said_in_sentences(letter, service):
    ending = Ending([verdict(letter, service)], [], 3, 0, False, ["post5", "post3"])
    said = shortfalls(ending, Expectation(bumps_at_most=2, told=("charge low",), posts=("post3", "post1")))
    assert said == [
        "order o1 was to be delivered, and is lost: never loaded, and it was not reported",
        "3 bumps, at most 2 were expected",
        "not every robot is in a dock",
        "'charge low' was not reported",
        "the way went over post5, post3, not post3, post1",
    ]


def legs(*posts: str) -> tuple[Leg, ...]:
    return tuple(Leg(from_post=a, to_post=b) for a, b in pairwise(posts))


def test_one_corridor_is_never_granted_to_two_and_whoever_is_out_has_a_free_way_home():
    traffic = Interlocking(builtin_map("carleton"), {"r1": "uc", "r2": "canal"})
    traffic.claim(Claimed("r1", "c1", legs("uc", "azrieli")))
    traffic.claim(Claimed("r2", "c2", legs("canal", "uc")))
    assert [one.robot for one in traffic.grants()] == ["r1"], "r2 would stand in r1's way home"
    traffic.clear("r1", *legs("uc", "azrieli"))
    assert traffic.grants() == [], "it is still out"
    traffic.in_dock("r1")
    assert [one.robot for one in traffic.grants()] == ["r2"]
    assert traffic.may_be_in("r2", "canal-uc")
    assert not traffic.may_be_in("r1", "azrieli-uc")
