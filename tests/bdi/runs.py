"""An agent that is run in steps, and what its body sees of it."""

from bdi import Agent, Finished, parse_program


class Run:
    """Cycles of 0.1 s. Actions that are not `quick` go on until the test says that they are done."""

    def __init__(self, program: str, quick: bool = True) -> None:
        self.agent = Agent(parse_program(program))
        self.quick = quick
        self.cycles = 0
        self.said: list[str] = []
        self.cancelled: list[str] = []
        self.failures: list[str] = []
        self.names: dict[int, str] = {}
        self.news: list[Finished] = []

    def more(self, cycles: int, *done: str, percepts: set[str] | None = None) -> list[str]:
        """Return what is started or printed in the next cycles; these actions end before the first."""
        said: list[str] = []
        self.news += [Finished(number) for number, name in self.names.items() if name in done]
        for _ in range(cycles):
            self.cycles += 1
            outcome = self.agent.cycle(percepts, (), self.news, self.cycles / 10)
            said += [*outcome.printed, *map(str, outcome.actions)]
            self.names |= {action.id: str(action) for action in outcome.actions}
            self.cancelled += [self.names[number] for number in outcome.cancelled]
            self.failures += [f"{failure.goal} {failure.error}" for failure in outcome.failures]
            self.news = [Finished(action.id) for action in outcome.actions] if self.quick else []
        self.said += said
        return said


def said(program: str, cycles: int = 40) -> list[str]:
    return Run(program).more(cycles)
