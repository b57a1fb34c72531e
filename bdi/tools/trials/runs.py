"""One program on trial: run it as its script says, and compare what happens with what is expected."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from bdi.language.terms import show
from bdi.tools.percept_file import Stimulus
from bdi.tools.simulation import Happened, Setting, Simulation
from bdi.tools.trials.differences import Difference, compared
from bdi.tools.trials.expectations import Expectation, Kind, Line

CYCLES_AFTER = 60  # so much longer than the last line a test runs, to see what comes unexpectedly
CYCLES_UNTIMED = 1_000  # the longest test of an order


@dataclass(frozen=True, slots=True)
class Trial:
    """A program to run, and the expected outputs."""

    setting: Setting
    expectation: Expectation

    @property
    def name(self) -> str:
        return " ".join(map(str, self.setting.programs))


def long_enough(expectation: Expectation, stimuli: Sequence[Stimulus]) -> int:
    """Return how many cycles a test runs by default."""
    if not expectation.by_cycle:
        return CYCLES_UNTIMED
    return max(expectation.last_cycle, len(stimuli)) + CYCLES_AFTER


@dataclass(frozen=True, slots=True)
class Result:
    trial: Trial
    cycles: int
    lines: tuple[Line, ...]  # what happened
    differences: tuple[Difference, ...]

    @property
    def as_expected(self) -> bool:
        return all(each.mark == " " for each in self.differences)

    def data(self) -> dict[str, object]:
        return {
            "program": self.trial.name,
            "as_expected": self.as_expected,
            "cycles": self.cycles,
            "differences": [each.data() for each in self.differences if each.mark != " "],
        }


def run_trial(trial: Trial) -> Result:
    """Raises BdiError for a program that cannot be run."""
    simulation = Simulation(trial.setting)
    expectation = trial.expectation
    lines: list[Line] = []
    wrong: list[Difference] = []
    names = set(simulation.agents)
    while happened := simulation.cycle():
        for each in happened:
            lines += _lines(each, expectation.says)
        names.update(simulation.agents)
        wrong += _wrong_beliefs(simulation, expectation.beliefs, simulation.number)
    wrong += _wrong_beliefs(simulation, expectation.beliefs, None)
    wrong += [
        Difference("?", line, f"the run ended after {simulation.number} cycles")
        for line in expectation.beliefs
        if line.cycle is not None and line.cycle > simulation.number
    ]
    differences = [*compared(expectation.events, lines), *wrong]
    if len(names) == 1:
        lines = [replace(line, agent="") for line in lines]
        differences = [each._replace(line=replace(each.line, agent="")) for each in differences]
    if expectation.by_cycle:
        differences.sort(key=lambda each: each.line.cycle or 0)
    return Result(trial, simulation.number, tuple(lines), tuple(differences))


def _lines(happened: Happened, says: bool) -> list[Line]:
    done = [Line(Kind.ACTION, show(action.term), happened.cycle, happened.agent) for action in happened.outcome.actions]
    said = [Line(Kind.SAYS, line, happened.cycle, happened.agent) for line in happened.outcome.printed] if says else []
    return done + said


def _wrong_beliefs(simulation: Simulation, expected: Sequence[Line], cycle: int | None) -> list[Difference]:
    wrong = []
    for line in expected:
        if line.cycle != cycle:
            continue
        for name, agent in simulation.agents.items():
            if line.agent in ("", name) and agent.believes(line.text) is not (line.kind is Kind.BELIEVES):
                believed = "is not believed" if line.kind is Kind.BELIEVES else "is believed"
                wrong.append(Difference("?", line, believed))
    return wrong
