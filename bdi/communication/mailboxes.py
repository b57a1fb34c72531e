"""Mailboxes of agents: messages that are sent in a round are read in the next."""

from collections.abc import Iterable
from dataclasses import replace

from bdi.model.messages import EVERYBODY, Message, own_copy


class Mailboxes:
    """One inbox for each agent of the system; `outside` names further receivers."""

    def __init__(self, outside: Iterable[str]) -> None:
        self.outside = set(outside)
        self.sent: list[Message] = []
        self.lost: list[Message] = []  # never read
        self._inboxes: dict[str, list[Message]] = {}

    def open_inbox(self, name: str) -> None:
        self._inboxes[name] = []

    def close_inbox(self, name: str) -> None:
        self.lost += self._inboxes.pop(name)

    def take(self, name: str) -> list[Message]:
        """Take all messages for this agent."""
        taken, self._inboxes[name] = self._inboxes[name], []
        return taken

    @property
    def is_empty(self) -> bool:
        return not any(self._inboxes.values())

    def deliver(self, message: Message) -> bool:
        """Return True if the receiver is or was an agent of the system, False if the message goes outside."""
        if message.receiver == EVERYBODY:
            others = [name for name in self._inboxes if name != message.sender]
            self.deliver_all(replace(message, content=own_copy(message.content), receiver=name) for name in others)
            return True
        self.sent.append(message)
        if message.receiver in self._inboxes:
            self._inboxes[message.receiver].append(message)
        elif message.receiver in self.outside:
            return False
        else:
            self.lost.append(message)
        return True

    def deliver_all(self, messages: Iterable[Message]) -> None:
        for message in messages:
            self.deliver(message)
