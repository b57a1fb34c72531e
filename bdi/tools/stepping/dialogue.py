"""The commands of step mode."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any

from rich.console import Console
from rich.markup import escape

from bdi.debug.explain import UNKNOWN
from bdi.language.errors import BdiError
from bdi.language.terms import show
from bdi.reasoning.agent import Agent
from bdi.tools.stepping.breakpoints import Breakpoint, breakpoint_of, is_written_in, stop_in
from bdi.tools.stepping.picture import belief, intentions, picture, waiting
from bdi.tools.stepping.stepper import Cycle, Stepper, goals_of, stacks_of, waiting_in

HELP = """Enter, n [N]   the next cycle, or the next N
c              go on to the next breakpoint
b WHAT         stop at +!goto/2, +at(post1), -at, @label, drive/1
b              list the breakpoints        d [WHAT]  delete one, or all
f WHAT         show only cycles about it   f         show all again
w GOAL         why is it not reached yet?
p FORMULA      what is believed            p         all beliefs
i              intentions                  a NAME    look at another agent
back [N]       N cycles back               q         quit"""


class Dialogue:
    """Carries out commands, one line each."""

    def __init__(self, stepper: Stepper, console: Console, dump: Callable[[Any], str] | None = None) -> None:
        self.stepper = stepper
        self.console = console
        self.breakpoints: list[Breakpoint] = []
        self.filter: Breakpoint | None = None
        self.agent = next(iter(stepper.agents), "")
        self._dump = dump  # makes JSON, if that is wanted

    def hold(self, lines: Iterable[str]) -> None:
        """Obey commands until `q` or the end of the input."""
        commands: dict[str, Callable[[str], None]] = {
            "": self.next,
            "n": self.next,
            "c": self.go_on,
            "b": self.stop_at,
            "d": self.delete,
            "f": self.only,
            "w": self.why,
            "p": self.believed,
            "i": self.doing,
            "a": self.look_at,
            "back": self.back,
            "h": self.help,
            "help": self.help,
            "?": self.help,
        }
        for line in lines:
            word, _, rest = line.strip().partition(" ")
            if word in ("q", "quit"):
                return
            command = commands.get(word)
            if command is None:
                self._say(f"{word} is no command; h shows them", "yellow")
                continue
            try:
                command(rest.strip())
            except BdiError as error:
                self._say(str(error), "red")
            except KeyboardInterrupt:
                self._say(f"interrupted after cycle {self.stepper.number}", "yellow")

    # ---- going on --------------------------------------------------------------------------------------------------

    def next(self, count: str) -> None:
        """n, n 5"""
        for _ in range(self._number(count)):
            shown = self._advance()
            if shown is None:
                return
            self._show(shown)

    def go_on(self, _: str) -> None:
        """c"""
        passed = 0
        while cycles := self.stepper.cycle():
            for cycle in cycles:
                why = stop_in(cycle, self.breakpoints)
                if why is not None:
                    self._passed(passed)
                    self._show(cycles)
                    self._say(f"stopped: {why}", "yellow")
                    return
            passed += 1
        self._passed(passed)
        self._over()

    def back(self, count: str) -> None:
        """back, back 3"""
        cycles = self.stepper.back_to(max(0, self.stepper.number - self._number(count)))
        if cycles:
            self._show(cycles)
        else:
            self._say("before the first cycle", "dim")

    def _advance(self) -> list[Cycle] | None:
        """The next cycles that the filter lets through."""
        passed = 0
        while cycles := self.stepper.cycle():
            shown = [each for each in cycles if self.filter is None or self.filter.hit(each) is not None]
            if shown:
                self._passed(passed)
                return shown
            passed += 1
        self._passed(passed)
        self._over()
        return None

    def _number(self, text: str) -> int:
        return max(1, int(text)) if text.isdecimal() else 1

    # ---- where to stop, what to show -------------------------------------------------------------------------------

    def stop_at(self, what: str) -> None:
        """b +!goto/2"""
        if what:
            self.breakpoints.append(breakpoint_of(what))
            self._say(f"stops at {what}", "dim")
            name = self.breakpoints[-1].name
            if not any(is_written_in(name, agent) for agent in self.stepper.agents.values()):
                self._say(f"no plan has the name {name} in it", "yellow")
        elif not self.breakpoints:
            self._say("no breakpoints; b +!goto/2 makes one", "dim")
        for each in self.breakpoints if not what else ():
            self._say(f"  {each.text}", "")

    def delete(self, what: str) -> None:
        """d +!goto/2, d"""
        kept = [each for each in self.breakpoints if what and each.text != what]
        self._say(f"{len(self.breakpoints) - len(kept)} deleted", "dim")
        self.breakpoints = kept

    def only(self, what: str) -> None:
        """f +!goto/2, f"""
        self.filter = breakpoint_of(what) if what else None
        self._say(f"shows only cycles about {what}" if what else "shows every cycle", "dim")

    # ---- looking in ------------------------------------------------------------------------------------------------

    def why(self, goal: str) -> None:
        """w deliver(_)"""
        if not goal:
            self._say("w GOAL, such as w deliver(_)", "yellow")
            return
        why = self._looked_at().why(goal)
        if self._dump:
            self._data(why.data())
            return
        self._say(why.sentence, "")
        if why.kind == UNKNOWN:
            self._say(f"Pursued are: {', '.join(goals_of(self._looked_at())) or 'none'}.", "dim")
        if why.chosen:
            self._say(f"{why.chosen[0].upper()}{why.chosen[1:]}.", "dim")

    def believed(self, formula: str) -> None:
        """p battery(B) & B < 20, p"""
        agent = self._looked_at()
        if not formula:
            found = sorted(show(literal) for literal in agent.beliefs)
            if self._dump:
                self._data({"beliefs": found})
            for text in found if not self._dump else ():
                self.console.print(belief(text))
            return
        answers = agent.ask(formula)
        if self._dump:
            self._data({"answers": [{name: show(value) for name, value in each.items()} for each in answers]})
            return
        for answer in answers:
            self._say(", ".join(f"{name}={show(value)}" for name, value in answer.items()) or "yes", "")
        if not answers:
            self._say("no", "")

    def doing(self, _: str) -> None:
        """i"""
        agent = self._looked_at()
        if self._dump:
            stacks = [stack.data() for stack in stacks_of(agent)]
            self._data({"intentions": stacks, "waiting": list(waiting_in(agent))})
            return
        parts = [*intentions(stacks_of(agent)), *waiting(waiting_in(agent))]
        for part in parts:
            self.console.print(part)
        if not parts:
            self._say("no intentions", "dim")

    def look_at(self, name: str) -> None:
        """a bob"""
        if name in self.stepper.agents:
            self.agent = name
        else:
            self._say(f"there is no agent {name}; there are {', '.join(self.stepper.agents)}", "yellow")

    def help(self, _: str) -> None:
        """h"""
        self._say(HELP, "")

    def _looked_at(self) -> Agent:
        agents = self.stepper.agents
        return agents.get(self.agent) or next(iter(agents.values()))

    # ---- showing ---------------------------------------------------------------------------------------------------

    def _show(self, cycles: Sequence[Cycle]) -> None:
        for cycle in cycles:
            if self._dump:
                self._data(cycle.data())
            else:
                self.console.print(picture(cycle, len(self.stepper.agents) > 1))

    def _passed(self, count: int) -> None:
        if count and not self._dump:
            self._say(f"… {count} cycle{'' if count == 1 else 's'}", "dim")

    def _over(self) -> None:
        if not self._dump:
            self._say(f"the run is over after {self.stepper.number} cycles", "dim")

    def _say(self, text: str, style: str) -> None:
        if self._dump:
            self._data({"message": text})
        else:
            self.console.print(escape(text), style=style or None)

    def _data(self, data: Any) -> None:
        if self._dump:
            self.console.print(escape(self._dump(data)), soft_wrap=True)
