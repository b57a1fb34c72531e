"""Events on their way into the queue of an agent, and waiters that are notified of them."""

from bdi.language.syntax import BELIEF_ADDED, Trigger
from bdi.language.terms import Literal
from bdi.model.intentions import WAITS_FOR_EVENT, Event, Intention, event_of
from bdi.model.plans import Options, relevant
from bdi.reasoning.circumstance import Circumstance


class EventQueue:
    """Posts the events of one agent."""

    __slots__ = ("agent",)

    def __init__(self, agent: Circumstance) -> None:
        self.agent = agent

    def wait_for_event(self, intention: Intention, event: Event) -> None:
        intention.state = WAITS_FOR_EVENT
        (self.agent.suspended_events if intention.suspended else self.agent.events).append(event)

    def notice(self, trigger: Trigger, literal: Literal) -> None:
        """Post an event of the world.

        An addition is queued even if no plan is about it yet: one may have arrived by its turn. (Not while an atomic
        plan holds the agent: the queue would only grow.) A deletion is queued only for plans, or if sub-plans may be
        about it.
        """
        agent = self.agent
        event = event_of(trigger, literal, self.relevant_plans(trigger, literal))
        if event.options or agent.attentive or (trigger is BELIEF_ADDED and agent.atomic is None):
            agent.events.append(event)
        if agent.waiters:
            self.tell_waiters(trigger, literal)

    def tell_waiters(self, trigger: Trigger, literal: Literal) -> None:
        for waiter in self.agent.waiters:
            waiter.notice(trigger, literal, self.agent)

    def relevant_plans(self, trigger: Trigger, literal: Literal) -> Options:
        return relevant(self.agent.library.options(trigger, literal.predicate), literal)
