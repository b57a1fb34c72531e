"""From nothing to the first action of the paper's agent: python first_python_agentspeak.py FOLDER."""

import sys
from pathlib import Path

from python_agentspeak import PythonAgentSpeak

folder = Path(sys.argv[1])
interpreter = PythonAgentSpeak(folder)
cycle = interpreter.start("paper")
with (folder / "paper.script").open() as script:
    for line in script:
        percepts, _, goal = line.rstrip("\n").partition("\t")
        cycle(frozenset(percepts.split()), goal)
        if interpreter.acted:
            break
