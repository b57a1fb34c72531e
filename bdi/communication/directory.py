"""The directory facilitator: which agent offers which service, and the agents that subscribed to it."""

from typing import NamedTuple

from bdi.language.terms import Literal, String, atom, structure
from bdi.model.messages import Message

FACILITATOR = "df"
ANY_KIND = ""


class Entry(NamedTuple):
    """An agent and a service, with a kind (also called type) if it was given one."""

    agent: str
    service: str
    kind: str

    def is_about(self, service: str, kind: str) -> bool:
        return self.service == service and kind in (ANY_KIND, self.kind)


class Directory:
    """Every change answers with the messages that it causes: `provider(AGENT,"SERVICE")[source(df)]`."""

    def __init__(self) -> None:
        self._offers: dict[Entry, None] = {}
        self._subscriptions: dict[Entry, None] = {}

    def register(self, agent: str, service: str, kind: str = ANY_KIND) -> list[Message]:
        offer = Entry(agent, service, kind)
        if offer in self._offers:
            return []
        self._offers[offer] = None
        return self._to_subscribers("tell", offer)

    def deregister(self, agent: str, service: str, kind: str = ANY_KIND) -> list[Message]:
        gone = [offer for offer in self._offers if offer.agent == agent and offer.is_about(service, kind)]
        return self._withdraw(gone)

    def search(self, service: str, kind: str = ANY_KIND) -> list[str]:
        """The agents that offer it, each once, in the order in which they registered."""
        return list(dict.fromkeys(offer.agent for offer in self._offers if offer.is_about(service, kind)))

    def subscribe(self, agent: str, service: str, kind: str = ANY_KIND) -> list[Message]:
        """Subscribe: notified at once of those that are there, and later of every change."""
        self._subscriptions[Entry(agent, service, kind)] = None
        return [_news("tell", agent, offer) for offer in self._offers if offer.is_about(service, kind)]

    def forget(self, agent: str) -> list[Message]:
        """The agent is no more."""
        self._subscriptions = {each: None for each in self._subscriptions if each.agent != agent}
        return self._withdraw([offer for offer in self._offers if offer.agent == agent])

    def _withdraw(self, offers: list[Entry]) -> list[Message]:
        for offer in offers:
            del self._offers[offer]
        return [message for offer in offers for message in self._to_subscribers("untell", offer)]

    def _to_subscribers(self, performative: str, offer: Entry) -> list[Message]:
        return [
            _news(performative, each.agent, offer)
            for each in self._subscriptions
            if offer.is_about(each.service, each.kind) and each.agent != offer.agent
        ]


def _news(performative: str, subscriber: str, offer: Entry) -> Message:
    provider: Literal = structure("provider", atom(offer.agent), String(offer.service))
    return Message(FACILITATOR, performative, provider, subscriber)
