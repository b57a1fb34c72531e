"""Random programs that suspend, resume, drop, succeed and fail each other's goals: every started
action is finished or cancelled exactly once, and nothing of a goal that is over stays behind."""

import pytest
from hypothesis import HealthCheck, given, note, settings
from hypothesis import strategies as st

from bdi import Agent, Finished, Message, Outcome, parse_program
from bdi.model.intentions import State

GOALS = ("g0", "g1", "g2", "g3")
goal = st.sampled_from(GOALS)
simple = st.one_of(
    st.just("act"),
    st.just("+b(1)"),
    st.just("-b(_)"),
    st.sampled_from([".wait(100)", ".wait(300)", '.wait("+b(X)")', '.wait("+c", 200)', ".wait(b(Y), 300, Ms)"]),
    st.sampled_from([".fail", ".suspend", ".drop_intention", ".drop_all_intentions", ".drop_all_desires", "?b(Z)"]),
    st.just(".send(bob, askOne, where, W, 300)"),
    st.builds(
        "{}({})".format,
        st.sampled_from(
            [
                *[".suspend", ".resume", ".drop_intention", ".drop_desire", ".drop_event", ".drop_future_intention"],
                *[".succeed_goal", ".fail_goal", ".done"],
            ]
        ),
        goal,
    ),
    st.builds("{}{}{}".format, st.sampled_from(["!", "!!"]), goal, st.sampled_from(["", "[hard_deadline(400)]"])),
)
step = st.one_of(
    simple,
    simple,
    st.builds("({}; {}) {} ({})".format, simple, simple, st.sampled_from(["|&|", "|||"]), simple),
    st.builds("(({}) ||| ({}; {})) |&| ({})".format, simple, simple, simple, simple),
)
body = st.lists(step, min_size=1, max_size=4).map("; ".join)
label = st.sampled_from(["", "", "@[atomic] "])


@st.composite
def programs(draw: st.DrawFn) -> str:
    plans = ["!g0. !g1. !free.", "+!free <- .wait(1500); .resume(_); .wait(500); .resume(_)."]
    for name in GOALS:
        condition = draw(st.sampled_from(["", "", " <: b(2)"]))
        plans.append(f"{draw(label)}+!{name}{condition} <- {draw(body)}.")
        if draw(st.booleans()):
            plans.append(f"-!{name} <- {draw(body)}.")
    if draw(st.booleans()):
        plans.append(f"+b(_) <- {draw(body)}.")
    if draw(st.booleans()):
        plans.append("^!G <- +heard(G).")
    if draw(st.booleans()):
        plans.append('priorities([high,low]). priority("+!g0", low). priority("+!g2", high).')
    return "\n".join(plans)


class Body:
    """A body's record of its actions: started, over, cancelled."""

    def __init__(self) -> None:
        self.open: list[int] = []
        self.cancelled: set[int] = set()
        self.over: set[int] = set()

    def hear(self, outcome: Outcome) -> None:
        for action in outcome.actions:
            assert action.id not in self.open
            self.open.append(action.id)
        for number in outcome.cancelled:
            assert number in self.open, "cancelled twice, or after its end"
            self.open.remove(number)
            self.cancelled.add(number)

    def end(self, which: int, fails: bool) -> list[Finished]:
        if not self.open:
            return []
        number = self.open.pop(which % len(self.open))
        self.over.add(number)
        return [Finished(number, "jammed" if fails else None)]


def check(agent: Agent, body: Body) -> None:
    alive = list(agent.intentions.values())
    running = list(agent.running)
    assert len(running) == len(set(map(id, running))), "twice in running"
    for intention in running:
        assert intention in alive
        assert intention.state is State.RUNNING
        assert not intention.suspended
        assert intention.stack
    assert sorted(agent.pending) == sorted(body.open)
    for number, intention in agent.pending.items():
        assert intention in alive
        assert (intention.action, intention.state) == (number, State.ACTION)
    waiting = [waiter.intention for waiter in agent.waiters] + [timer[2] for timer in agent.timers]
    waiting += [asked.intention for asked in agent.asked.values()]
    assert all(intention in alive for intention in waiting)
    assert len(waiting) == len(set(map(id, waiting))), "waits for two things"
    for event in agent.events:
        assert event.intention is None or (event.intention in alive and not event.intention.suspended)
    for event in agent.suspended_events:
        assert event.intention is None or event.intention.suspended
    assert agent.atomic is None or agent.atomic in alive
    by_event = [event.intention for event in (*agent.events, *agent.suspended_events) if event.intention is not None]
    busy = {*map(id, running), *map(id, waiting), *map(id, agent.pending.values()), *map(id, by_event)}
    for intention in alive:
        kept = intention.suspended or intention.state is State.CONDITION
        assert id(intention) in busy or kept, f"{intention} is forgotten"
        if intention.fork is not None:
            assert intention in intention.fork.intentions()
            assert all(each in alive for each in intention.fork.outermost().intentions())


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(programs(), st.lists(st.tuples(st.integers(0, 5), st.integers(0, 3)), min_size=5, max_size=40))
@pytest.mark.nightly
def test_whatever_goals_do_to_each_other_nothing_is_lost_or_left(program: str, fates: list[tuple[int, int]]) -> None:
    note(program)
    agent = Agent(parse_program(program), name="r1")
    known = Body()
    news: list[Finished] = []
    for cycle in range(60):
        which, fate = fates[cycle % len(fates)]
        messages = [Message("bob", "tell", f"b({fate})")] if which == 5 else []
        known.hear(agent.cycle(None, messages, news, cycle / 10))
        if not agent.feedback:
            check(agent, known)
        news = known.end(which, fate == 0) if fate < 2 else []
    if agent.idle:
        assert not known.open
        assert not agent.running
        assert not agent.timers
