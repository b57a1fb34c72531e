"""The table of transitions, driven at random: whatever is said, orders stay in lives that the design knows."""

from pathlib import Path

from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from app.models import OrderState as S
from app.orders.transitions import (
    CARRIED,
    ENDED,
    MAIL_ABOARD,
    NOTHING_ABOARD,
    TRANSITIONS,
    By,
    is_allowed,
    is_old_news,
)

WORDS = st.sampled_from(By)
STATES = st.sampled_from(S)


class LifeOfAnOrder(RuleBasedStateMachine):
    """Everybody says anything at any time; only what the table allows happens."""

    def __init__(self) -> None:
        super().__init__()
        self.state = S.QUEUED
        self.before_attention: S | None = None
        self.legs = 1
        self.past = [S.QUEUED]

    @rule(to=STATES, by=WORDS)
    def an_actor_says(self, to: S, by: By) -> None:
        if is_allowed(self.state, to, by, self.before_attention, is_passed_on=self.legs > 1):
            if to is S.QUEUED and (self.before_attention or self.state) in MAIL_ABOARD:
                self.legs += 1
            self.before_attention = self.state if to is S.ATTENTION else None
            self.state = to
            self.past.append(to)

    @rule(step=st.integers(0, 9), by=WORDS)
    def an_actor_says_what_may_follow(self, step: int, by: By) -> None:
        following = [*TRANSITIONS[self.state], *([self.before_attention] if self.before_attention else [])]
        if following:
            self.an_actor_says(following[step % len(following)], by)

    @invariant()
    def what_has_ended_stays(self) -> None:
        assert not ENDED & set(self.past[:-1])

    @invariant()
    def delivered_mail_was_loaded_and_once_for_each_leg(self) -> None:
        without_faults = [
            s for i, s in enumerate(self.past) if s is not S.ATTENTION and self.past[i - 1] is not S.ATTENTION
        ]
        assert without_faults.count(S.CARRYING) <= self.legs
        if S.DELIVERED in self.past:
            assert self.past.index(S.CARRYING) < self.past.index(S.DELIVERED)

    @invariant()
    def nothing_aboard_is_cancelled_or_expires(self) -> None:
        if self.state in {S.CANCELLED, S.EXPIRED}:
            assert not MAIL_ABOARD & set(self.past)

    @invariant()
    def attention_knows_where_it_came_from(self) -> None:
        assert (self.state is S.ATTENTION) == (self.before_attention is not None)


TestLifeOfAnOrder = LifeOfAnOrder.TestCase


def test_every_state_has_its_place_in_the_table() -> None:
    assert set(TRANSITIONS) == set(S)


def test_every_state_can_be_reached_and_every_life_can_end() -> None:
    reached, waiting = {S.QUEUED}, [S.QUEUED]
    while waiting:
        for following in TRANSITIONS[waiting.pop()]:
            if following not in reached:
                reached.add(following)
                waiting.append(following)
    assert reached == set(S)
    assert {S.DELIVERED, S.RETURNED, S.HELD, S.EXPIRED, S.CANCELLED} == ENDED


def test_only_the_robot_writes_custody() -> None:
    """Loaded, received and returned are confirmed by the robot's receipt alone; what it claims and
    does not prove, by the dispatcher who has asked (`resolve`, with nothing claimed, refuses)."""
    for state, following in TRANSITIONS.items():
        for custody in (S.CARRYING, S.DELIVERED, S.RETURNED):
            word = By.DISPATCHER if state is S.ATTENTION else By.ROBOT
            assert following.get(custody, {word}) == {word}, state


def test_out_of_attention_leads_back_or_home_or_into_hands_as_far_as_the_mail_allows() -> None:
    for before in S:
        claimed = {S.DELIVERED, S.RETURNED}
        out = {S.RETURNING, S.HELD, *claimed} if before in MAIL_ABOARD else {S.QUEUED, S.CANCELLED}
        if before in CARRIED:
            out.add(S.QUEUED)  # passed on to another robot
        assert {to for to in S if is_allowed(S.ATTENTION, to, By.DISPATCHER, before)} == {before} | out
        assert {to for to in S if is_allowed(S.ATTENTION, to, By.ROBOT, before)} == {before}, "it went on by itself"
    for by in (By.SENDER, By.RECIPIENT, By.TIMER):
        assert not any(is_allowed(S.ATTENTION, to, by, before) for to in S for before in S)


def test_what_was_passed_on_ends_in_the_mailrooms_hands_and_what_was_not_with_its_sender() -> None:
    for state in NOTHING_ABOARD:
        for by in By:
            for to in (S.CANCELLED, S.EXPIRED):
                assert not is_allowed(state, to, by, is_passed_on=True)
            assert not is_allowed(state, S.HELD, by)
        assert is_allowed(state, S.HELD, By.DISPATCHER, is_passed_on=True)
    assert not is_allowed(S.ATTENTION, S.HELD, By.DISPATCHER, S.TO_SENDER)


def test_what_lies_behind_an_order_is_old_news_and_what_lies_ahead_is_not() -> None:
    assert is_old_news(S.CARRYING, S.AT_SENDER)
    assert not is_old_news(S.AT_SENDER, S.CARRYING)
    assert is_old_news(S.ATTENTION, S.AT_SENDER, S.CARRYING)
    assert is_old_news(S.DELIVERED, S.AT_RECIPIENT)
    assert not is_old_news(S.CANCELLED, S.DELIVERED), "a contradiction, to be refused by name"


def table_of_the_docs() -> str:
    """The table of transitions as docs/reference/orders.md shows it."""
    rows = [
        f"| {state} | {', '.join(f'{to} ({_words(by)})' for to, by in following.items()) or 'an end'} |"
        for state, following in TRANSITIONS.items()
    ]
    return "\n".join(["| from | to (on whose word) |", "|---|---|", *rows])


def _words(by: set[By]) -> str:
    return ", ".join(sorted(by))


def test_the_docs_show_the_table_as_it_is() -> None:
    assert table_of_the_docs() in (Path(__file__).parents[3] / "docs" / "reference" / "orders.md").read_text()
