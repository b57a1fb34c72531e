"""People who use the service as a browser would, over HTTP, and the mails that are written to them."""

import re
import uuid
from collections import Counter
from collections.abc import Iterator
from email import message_from_bytes, policy
from email.message import EmailMessage
from pathlib import Path
from typing import Any

import httpx

from demo.settings import DemoFailed, Demonstration


class Spool:
    """The mails that the service has written."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def new_mails(self, known: set[str]) -> Iterator[tuple[str, EmailMessage]]:
        """Mails that are not `known` yet, as (file name, mail); they are known from then on."""
        for file in sorted(self._folder.glob("*.eml"), key=lambda one: one.stat().st_mtime_ns):
            if file.name not in known:
                known.add(file.name)
                yield file.name, message_from_bytes(file.read_bytes(), policy=policy.default)

    def notices(self, order_id: str) -> Counter[tuple[str, str]]:
        """Count the mails about an order that each person got, as (address, kind)."""
        kinds = {name: mail for name, mail in self.new_mails(set()) if name.startswith(f"mail.{order_id}.")}
        return Counter((str(mail["To"]), name.split(".")[2]) for name, mail in kinds.items())


def sign_in_code(mail: EmailMessage) -> str | None:
    """The code in a mail, if it is one for signing in."""
    body = mail.get_body(("plain",))
    found = re.search(r"\b\d{8}\b", body.get_content()) if body else None
    return found[0] if found and str(mail["Message-ID"]).startswith("<sign-in.") else None


class NoCameraError(DemoFailed):
    """The robot's process does not run: there is no camera to show a code to."""


class SimulatedPerson:
    """A person with a browser."""

    def __init__(self, email: str, demo: Demonstration) -> None:
        self.email = email
        self._demo = demo
        self._http = httpx.AsyncClient(
            base_url=f"{demo.url}/api/v1", headers={"Sec-Fetch-Site": "same-origin"}, timeout=20
        )

    async def sign_in(self) -> None:
        """By the link that a visitor gets, too. Raises DemoFailed."""
        answer = await self._answer("GET", self._demo.link(self.email, "order"))
        if not answer.has_redirect_location:
            raise DemoFailed(f"{self.email} could not sign in: {answer.text}")

    async def place_order(self, from_post: str, to_post: str, recipient: str, **more: str) -> dict[str, Any]:
        """`more`: what else the order form can say."""
        body = {"from_post": from_post, "to_post": to_post, "recipient": recipient, "description": "A letter", **more}
        placed: dict[str, Any] = await self._ask("POST", "/orders", body, {"Idempotency-Key": str(uuid.uuid4())})
        return placed

    async def order(self, order_id: str) -> dict[str, Any]:
        order: dict[str, Any] = await self._ask("GET", f"/orders/{order_id}")
        return order

    async def open_orders(self) -> list[dict[str, Any]]:
        """Those that go on, everybody's for a dispatcher; a hundred at most."""
        orders: list[dict[str, Any]] = (await self._ask("GET", "/orders?state=open&limit=100"))["items"]
        return orders

    async def alarms(self) -> list[dict[str, Any]]:
        """For dispatchers: what people should look at, newest first."""
        alarms: list[dict[str, Any]] = (await self._ask("GET", "/alarms?limit=50"))["items"]
        return alarms

    async def show_code(self, order_id: str) -> None:
        """Hold one's code to the robot's camera. Raises NoCameraError."""
        await self._ask("POST", "/demo/camera", {"order_id": order_id})

    async def robots(self) -> list[dict[str, Any]]:
        robots: list[dict[str, Any]] = (await self._ask("GET", "/robots"))["items"]
        return robots

    async def traffic(self) -> dict[str, Any]:
        """For dispatchers: the corridors that robots hold, and what they report to be in."""
        traffic: dict[str, Any] = await self._ask("GET", "/map/traffic")
        return traffic

    async def map(self) -> dict[str, Any]:
        campus: dict[str, Any] = await self._ask("GET", "/map")
        return campus

    async def notices(self, order_id: str) -> Counter[str]:
        """Count the notifications of each kind that this person got about an order."""
        items = (await self._ask("GET", "/notices?limit=100"))["items"]
        return Counter(str(notice["kind"]) for notice in items if notice["order_id"] == order_id)

    async def _ask(self, method: str, path: str, body: Any = None, headers: dict[str, str] | None = None) -> Any:
        answer = await self._answer(method, path, body, headers)
        if answer.is_error:
            failure = NoCameraError if answer.json().get("code") == "door_closed" else DemoFailed
            raise failure(f"{method} {path} was refused: {answer.text}")
        return answer.json()

    async def _answer(
        self, method: str, path: str, body: Any = None, headers: dict[str, str] | None = None
    ) -> httpx.Response:
        try:
            return await self._http.request(method, path, json=body, headers=headers)
        except httpx.HTTPError as error:
            raise DemoFailed(f"The service does not answer {method} {path}: {type(error).__name__}.") from error

    async def close(self) -> None:
        await self._http.aclose()
