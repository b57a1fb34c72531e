"""A visitor with a browser. Errors that the browser reports fail the test."""

import asyncio
import re
import uuid
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any

from playwright.async_api import Browser, BrowserContext, ConsoleMessage, Page

from tests.web.service import ROOT, Service

# Browsers write every refused request to the console. A page asks who is signed in, and for their orders, before it
# knows whether a person is signed in: this refusal is by design.
REFUSED = re.compile(r"Failed to load resource: the server responded with a status of 4\d\d")
UNAUTHORIZED = re.compile(r"Failed to load resource: the server responded with a status of 401")
WHO_AM_I = "/api/v1/me"
ORDERS = re.compile(r"/api/v1/orders(/[\w-]+)?")
NO_WORKER = "Service Worker registration blocked by Playwright"
RESYNC = """(name) => {
  const channel = new BroadcastChannel(name);
  channel.postMessage({ after: null, event: { kind: "resync", data: "null", id: "" } });
  channel.close();
}"""
AXE = ROOT / "web/node_modules/axe-core/axe.min.js"
AXE_RUN = """async () => {
  const tags = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"];
  const found = await axe.run(document, {runOnly: tags});
  return found.violations.map(({id, nodes}) => `${id}: ${nodes.map(({html}) => html.slice(0, 120)).join(" ")}`);
}"""
Visit = Callable[..., Any]
"""The type of the fixture `visit`."""
TOLD_APART_S = 0.3
TOLD_WITHIN_LOOKS = 20


@dataclass
class Visitor:
    """A person, signed in with `sign_in` or by the pages themselves."""

    browser: Browser
    service: Service
    email: str
    options: dict[str, Any]
    refusals_expected: set[str] = field(default_factory=lambda: {WHO_AM_I})
    complaints: list[str] = field(default_factory=list)
    loses_answers: bool = False
    loses_session: bool = False

    async def __aenter__(self) -> "Visitor":
        self.context: BrowserContext = await self.browser.new_context(base_url=self.service.url, **self.options)
        self.context.set_default_timeout(15_000)
        self.page = await self.new_page()
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for page in self.context.pages:
            await page.unroute_all(behavior="ignoreErrors")  # what a route still fetches is not the test's any more
        await self.context.close()
        if error is None:
            assert not self.complaints, f"the browser of {self.email} complains: {self.complaints}"

    async def new_page(self) -> Page:
        page = await self.context.new_page()
        page.on("console", self._hear)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        return page

    def _hear(self, message: ConsoleMessage) -> None:
        path = re.sub(r"^https?://[^/]+", "", message.location["url"]).partition("?")[0]
        expected = path in self.refusals_expected and REFUSED.match(message.text)
        expected = expected or (ORDERS.fullmatch(path) and UNAUTHORIZED.match(message.text))
        expected = expected or (self.loses_session and UNAUTHORIZED.match(message.text))
        expected = expected or (self.loses_answers and "net::ERR_" in message.text)
        expected = expected or message.text == NO_WORKER
        if message.type in ("error", "warning") and not expected:
            self.complaints.append(f"{message.text} ({path})")

    @asynccontextmanager
    async def without_network(self) -> AsyncIterator[None]:
        """The service cannot be reached from the page."""
        self.loses_answers = True
        await self.page.route("**/api/v1/**", lambda route: route.abort())
        yield
        await self.page.unroute_all()

    async def sign_in(self) -> "Visitor":
        """Without the pages, in a moment."""
        api = self.context.request
        own = {"Sec-Fetch-Site": "same-origin", "Accept-Language": self.options["locale"]}
        for path, more in (("/sign-in/codes", {}), ("/sign-in", {"code": None})):
            body = {"email": self.email, **({"code": self.service.code_mailed_to(self.email)} if more else {})}
            answer = await api.post(f"/api/v1{path}", data=body, headers=own)
            assert answer.ok, await answer.text()
        return self

    async def asks_anew(self) -> None:
        """Their page fetches everything once more, as when the tab that reads the stream has missed something."""
        person = await self.api("/me")
        await self.page.evaluate(RESYNC, f"live {person['id']}")

    async def end_sessions(self) -> None:
        """On the server, from elsewhere: this browser's cookie is good for nothing from now on."""
        self.loses_session = True
        async with Visitor(self.browser, self.service, self.email, self.options) as elsewhere:
            await elsewhere.sign_in()
            await elsewhere.delete("/sessions")

    async def assert_accessible(self, page: Page | None = None) -> None:
        """axe-core finds no violation of WCAG 2.2 A and AA on what the page shows now."""
        page = page or self.page
        await page.evaluate(AXE.read_text(encoding="utf-8"))
        violations = await page.evaluate(AXE_RUN)
        assert not violations, violations

    async def api(self, path: str) -> Any:
        """The answer of the service to this person."""
        answer = await self.context.request.get(f"/api/v1{path}", max_retries=1)  # an idle one may just have ended
        assert answer.ok, await answer.text()
        return await answer.json()

    async def order(self, recipient: str, from_post: str = "post1", to_post: str = "post4", what: str = "") -> str:
        """An order placed without the pages; its id."""
        body = {"from_post": from_post, "to_post": to_post, "recipient": recipient, "description": what}
        headers = {"Sec-Fetch-Site": "same-origin", "Idempotency-Key": str(uuid.uuid4())}
        answer = await self.context.request.post("/api/v1/orders", data=body, headers=headers)
        assert answer.ok, await answer.text()
        return str((await answer.json())["id"])

    async def is_told(self) -> None:
        """Once there is a first notice for them, and the event stream has had its last word about it."""
        for _ in range(TOLD_WITHIN_LOOKS):
            first, second = await self._told(), await self._told()
            if first == second and first[0]:
                return
        raise AssertionError(f"{self.email} is told nothing, or more and more")

    async def _told(self) -> tuple[int, str]:
        answer = await self.context.request.get("/api/v1/notices?limit=9", max_retries=1)
        await asyncio.sleep(TOLD_APART_S)
        return len((await answer.json())["items"]), answer.headers["feed-position"]

    async def orders(self, number: int, recipient: str) -> None:
        """Many of them, without description; a few at a time, as the service takes so many from one person."""
        for _ in range(number):
            await self.order(recipient)

    async def post(self, path: str, body: Any = None) -> Any:
        """Something done without the pages."""
        return await self._do("POST", path, body)

    async def put(self, path: str, body: Any) -> Any:
        """Something set without the pages."""
        return await self._do("PUT", path, body)

    async def delete(self, path: str) -> None:
        """Something ended without the pages."""
        answer = await self.context.request.delete(f"/api/v1{path}", headers={"Sec-Fetch-Site": "same-origin"})
        assert answer.ok, await answer.text()

    async def _do(self, method: str, path: str, body: Any) -> Any:
        own = {"Sec-Fetch-Site": "same-origin"}
        answer = await self.context.request.fetch(f"/api/v1{path}", method=method, data=body, headers=own)
        assert answer.ok, await answer.text()
        return await answer.json()

    async def name_delegate(self, order_id: str, email: str) -> None:
        """A delegate who hands over instead; without the pages too."""
        headers = {"Sec-Fetch-Site": "same-origin"}
        wish = {"name": "The porter", "email": email}
        answer = await self.context.request.post(f"/api/v1/orders/{order_id}/delegates", data=wish, headers=headers)
        assert answer.ok, await answer.text()
