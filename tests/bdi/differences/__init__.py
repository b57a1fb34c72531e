"""Programs that show what differs from Jason, by the row of docs/reference/agentspeak-differences.md."""

from collections.abc import Callable, Iterable

from bdi import Agent, Finished, MultiAgentSystem, Stimuli, parse_program

SHOWN: dict[str, Callable[[], None]] = {}


def shows(row: str) -> Callable[[Callable[[], None]], Callable[[], None]]:
    """The function shows what the row of this name says."""

    def register(test: Callable[[], None]) -> Callable[[], None]:
        assert row not in SHOWN
        SHOWN[row] = test
        return test

    return register


def happenings(program: str, percepts: Iterable[set[str] | None] = (), cycles: int = 30) -> list[str]:
    """ "3 p(1)" for every action, "3 says hello", "3 given up g", "3 cancels 1"; actions but `long` succeed at once."""
    agent = Agent(parse_program(program), name="ag", random_seed=7)
    queue = list(percepts)
    seen: list[str] = []
    finished: list[Finished] = []
    for cycle in range(1, cycles + 1):
        outcome = agent.cycle(queue.pop(0) if queue else None, [], finished, cycle / 10)
        seen += [f"{cycle} {action}" for action in outcome.actions]
        seen += [f"{cycle} says {line}" for line in outcome.printed]
        seen += [f"{cycle} given up {failure.goal} {failure.error}" for failure in outcome.failures]
        seen += [f"{cycle} cancels {number}" for number in outcome.cancelled]
        finished = [Finished(action.id) for action in outcome.actions if action.term.functor != "long"]
    return seen


def together(rounds: int = 20, **programs: str) -> list[str]:
    """ "3 ann p(1)" for every action of agents that run together."""
    agents = [Agent(parse_program(text), name=name) for name, text in programs.items()]
    system = MultiAgentSystem(agents, load=lambda name: parse_program("b(1)."))
    seen: list[str] = []
    stimuli: dict[str, Stimuli] = {}
    for number in range(1, rounds + 1):
        outcomes = system.round(stimuli, number / 10)
        seen += [f"{number} {name} {each}" for name, outcome in outcomes.items() for each in outcome.actions]
        stimuli = {
            name: Stimuli(finished=[Finished(action.id) for action in outcome.actions])
            for name, outcome in outcomes.items()
            if name in system.agents
        }
    return seen


def actions_of(seen: list[str]) -> list[str]:
    return [each.split(" ", 1)[1] for each in seen]
