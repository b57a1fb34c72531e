"""The plans of an agent, and what else its program adds: beliefs, rules, goals, functions."""

from collections.abc import Iterable

from bdi.builtin.agent_state.learning import learn
from bdi.builtin.program_check import check_program
from bdi.language.parser import literal_from
from bdi.language.syntax import Belief, Does, Function, Plan, Program
from bdi.language.terms import Code
from bdi.model.beliefs import SELF
from bdi.model.goal_states import GoalStates, is_meta
from bdi.reasoning.actions import Actions
from bdi.reasoning.circumstance import Circumstance
from bdi.reasoning.performatives import sourced
from bdi.reasoning.selection import Selection, table_of


class PlanBase:
    """Adds and removes plans, and loads programs."""

    __slots__ = ("actions", "agent", "selection")

    def __init__(self, agent: Circumstance, actions: Actions, selection: Selection) -> None:
        self.agent = agent
        self.actions = actions
        self.selection = selection

    def load(self, program: Program, functions: Iterable[Function] = ()) -> None:
        """Add what a program consists of; `functions` were registered before. Raises AgentSpeakError."""
        agent = self.agent
        check_program(program, agent.known_actions, agent.internal_actions, functions)
        table = table_of(program)
        if table is not None:
            self.selection.follow(table)
        for function in program.functions:
            agent.bound_actions.define(function)
        for plan in program.plans:
            self.add(plan)
        for clause in reversed(program.beliefs):
            if isinstance(clause, Belief):
                self.actions.believe(literal_from(clause.literal), None)
            else:
                agent.beliefs.relation(clause.head.predicate).add_rule(agent.logic.derivation(clause))
        for goal in program.goals:
            self.actions.achieve_apart(sourced(goal.literal, SELF))

    def include(self, program: Program) -> None:
        """Add more of the program while the agent is running: `.include`. Raises as `load` does."""
        self.load(program, self.agent.program.functions)
        self.agent.program = self.agent.program.joined(program)
        self.agent.percepts.forget_plans()

    def add(self, plan: Plan, first: bool = False) -> None:
        """.add_plan, tellHow"""
        agent = self.agent
        agent.library.add(plan, first)
        if agent.goal_states is None and is_meta(plan):
            agent.goal_states = GoalStates(agent)
            agent.attentive = True
        agent.percepts.forget_plans()
        self.selection.heed_subplans((plan,))

    def remove(self, label: str) -> bool:
        """Remove the plan with this label. Return False if there is none."""
        self.agent.percepts.forget_plans()
        return self.agent.library.remove(label)

    def learn(self, code: Code, does: Does) -> None:
        """+{ plan }   -{ rule }"""
        learn(self.agent, code, does)
