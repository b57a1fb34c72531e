"""Live diagnostics of a robot: its senses and its mind, while a technician watches. Nothing of it is kept."""

from typing import Annotated, Final, Literal

from pydantic import Field, StringConstraints

from protocol.parts import Identifier, Moment, Part, Seq

MAX_DIAGNOSTICS_BYTES: Final = 48 * 1024
"""Of the body as JSON. What has no room is left out, and how much that was is said."""

Text = Annotated[str, StringConstraints(max_length=300)]
"""AgentSpeak as it is written down; what is longer ends in "…"."""
Count = Annotated[int, Field(ge=0, le=2**53)]
Bump = Literal["left", "right"]
Drop = Literal["wheel_left", "wheel_right", "cliff_left", "cliff_front_left", "cliff_front_right", "cliff_right"]
Light = Literal["left", "front_left", "centre_left", "centre_right", "front_right", "right"]


class Sensors(Part):
    """The sensors now. `line`: left, centre, right diode over the line; `line_word` what that is taken for.

    `light_bumpers` see something near; `wheels_mm_s` are the speeds really sent last, `skill` is what has the wheels.
    `base_age_s` is how old the base's newest frame is, `camera_age_s` the camera's.
    """

    mode: Identifier | None = None
    docked: bool = False
    charging_state: Identifier | None = None
    voltage_mv: int | None = None
    current_ma: int | None = None
    temperature_c: int | None = None
    base_age_s: float | None = None
    camera_age_s: float | None = None
    bumps: tuple[Bump, ...] = ()
    drops: tuple[Drop, ...] = ()
    light_bumpers: tuple[Light, ...] = ()
    line: tuple[bool, bool, bool] = (False, False, False)
    line_word: Identifier
    wheels_mm_s: tuple[float, float]
    skill: Text | None = None
    faults: tuple[Identifier, ...] = ()


class LoopTiming(Part):
    """The delays of the ticks of one loop since the robot started."""

    name: Text
    ticks: Count
    late_p50_ms: float
    late_p99_ms: float
    late_worst_ms: float


class Because(Part):
    """Why a goal is not reached yet: `sentence` in English; `kind` names its pattern, the rest fills that in any
    language: `goal` in plan `plan` waits for `what`, for `left_s` at most, and is needed for the goals `needed_for`."""

    kind: Text
    sentence: Annotated[str, StringConstraints(max_length=1000)]
    goal: Text
    plan: Text | None = None
    what: Text | None = None
    left_s: float | None = None
    needed_for: tuple[Text, ...] = ()


class NotChosen(Part):
    """A plan that would have come first, and why it was not taken."""

    plan: Text
    why: Text


class Means(Part):
    """A goal or event of an intention, the plan that serves it, and the step that comes next (None: it is done).

    `place` is where the plan is written: `mission.asl:33`.
    `relevant` is how many plans there were for it, `passed_over` those that would have come first; both are known only
    of what was chosen while the robot was watched.
    """

    goal: Text
    plan: Text
    place: Text | None = None
    step: Text | None = None
    relevant: Count | None = None
    passed_over: tuple[NotChosen, ...] = ()


class IntentionReport(Part):
    """One intention: `stack` from its first cause down to what it is doing now, and why it does not go on.

    `beside` are the intentions that are branches of the same plan.
    """

    number: int
    state: Text
    because: Because
    stack: tuple[Means, ...]
    beside: tuple[int, ...] = ()


class TraceLine(Part):
    """One line of the agent's trace: what it chose, did, came to believe, or gave up, in cycle `cycle`.

    `chose`: a plan for an event, or none (`plan` None); `passed_over` were looked at before. `did`: a step of an
    intention. `believed` and `forgot`: a belief. `gave_up`: a goal.
    """

    cycle: Count
    kind: Literal["chose", "did", "believed", "forgot", "gave_up"]
    text: Text
    plan: Text | None = None
    place: Text | None = None
    intention: int | None = None
    passed_over: tuple[NotChosen, ...] = ()


class LeftOut(Part):
    """Counts of what had no room: of beliefs (`came` and `went`), of lines of the trace, of intentions."""

    beliefs: Count = 0
    trace: Count = 0
    intentions: Count = 0


class Diagnostics(Part):
    """Live diagnostics, while a technician watches: at most twice a second, dropped first, never kept.

    `number` counts from 1, which has all beliefs in `came` (`whole`); those after it say what `came` and `went` since
    the one before. `events` wait until a plan is chosen for them, `loops` are in every tenth. `at` is the robot's time.
    """

    number: Seq
    at: Moment
    cycle: Count
    whole: bool = False
    sensors: Sensors
    loops: tuple[LoopTiming, ...] = ()
    intentions: tuple[IntentionReport, ...] = ()
    events: tuple[Text, ...] = ()
    came: tuple[Text, ...] = ()
    went: tuple[Text, ...] = ()
    trace: tuple[TraceLine, ...] = ()
    left_out: LeftOut = LeftOut()
