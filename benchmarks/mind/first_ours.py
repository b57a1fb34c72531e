"""From nothing to the first action of the paper's agent: python first_ours.py FOLDER, measured as a whole process."""

import sys

from bdi import Agent, Message, load_program

folder = sys.argv[1]
agent = Agent(load_program(f"{folder}/paper.asl"))
with open(f"{folder}/paper.script") as script:  # noqa: PTH123 -- pathlib would be measured too
    for line in script:
        percepts, _, goal = line.rstrip("\n").partition("\t")
        if agent.cycle(percepts.split(), [Message("user", "achieve", goal)] if goal else ()).actions:
            break
