"""The metrics that a monitoring system reads, and the clients that are refused."""

import json
import logging
from collections.abc import Iterator

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from prometheus_client.parser import text_string_to_metric_families
from pydantic import SecretStr

from app.composition import create_app
from app.core.logs import set_up_logs
from app.core.settings import Settings
from protocol.clock import SteppedClock
from tests.app.conftest import HERE, Browser, Mailroom

TOKEN = "a-token-of-the-operator"

pytestmark = pytest.mark.mailed_codes


class Watcher(TestClient):
    """Prometheus on this machine."""

    def __init__(self, app: FastAPI, beside: TestClient) -> None:
        super().__init__(app, base_url=HERE, client=("127.0.0.1", 50000))
        self.portal = beside.portal

    def figures(self) -> dict[tuple[str, ...], float]:
        answer = self.get("/metrics")
        assert answer.status_code == 200, answer.text
        families = text_string_to_metric_families(answer.text)
        return {(s.name, *s.labels.values()): s.value for family in families for s in family.samples}


@pytest.fixture
def watcher(app: FastAPI, anonymous: TestClient) -> Watcher:
    return Watcher(app, anonymous)


def test_orders_robots_and_notices_are_counted(
    watcher: Watcher, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    delivered, carried = (sender.order().json()["id"] for _ in range(2))
    mailroom.move(carried, "assigned", "to_sender", "at_sender", "carrying")
    sender.order()
    clock.advance(90)
    mailroom.move(delivered, "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    figures = watcher.figures()
    assert figures["campus_mail_orders", "carrying"] == 1
    assert figures["campus_mail_orders", "delivered"] == 1
    assert figures["campus_mail_oldest_wait_seconds", "queued"] == pytest.approx(90, abs=1)
    assert ("campus_mail_oldest_wait_seconds", "delivered") not in figures
    assert figures["campus_mail_robot_online", "r1"] == 0
    assert figures[("campus_mail_notices_lag_seconds",)] >= 0
    requests = {key: value for key, value in figures.items() if key[0] == "campus_mail_http_requests_total"}
    assert [value for key, value in requests.items() if {"/api/v1/orders", "POST", "2xx"} <= set(key)] == [3]


def test_what_anybody_makes_up_is_not_counted_by_its_name(watcher: Watcher, sender: Browser) -> None:
    for path in ("/nowhere", "/api/v1/nowhere", "/api/v1/orders/made-up"):
        sender.get(path)
    for method in ("BREW", "HEAD"):
        assert sender.request(method, "/api/v1/orders").status_code == 405
    counted = {
        key[1:3]: value for key, value in watcher.figures().items() if key[0] == "campus_mail_http_requests_total"
    }
    assert counted["/api/v1/orders/{order_id}", "GET"] == 1
    assert counted["/api/v1/orders", "other"] == 2
    assert {path for path, _ in counted} == {
        "/api/v1/sign-in/codes",
        "/api/v1/sign-in",
        "/api/v1/orders",
        "/api/v1/orders/{order_id}",
    }


def test_how_far_a_promise_was_off_is_counted_once(
    watcher: Watcher, sender: Browser, mailroom: Mailroom, clock: SteppedClock
) -> None:
    mailroom.robot_connects()
    clock.advance(1)
    order = sender.order().json()
    clock.advance(3600)
    mailroom.move(order["id"], "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered")
    clock.advance(1)
    for _ in range(2):
        figures = watcher.figures()
        assert figures[("campus_mail_estimate_error_seconds_count",)] == 1
        # The timer may have noticed the delay meanwhile and told another window.
        assert 0 < figures[("campus_mail_estimate_error_seconds_sum",)] < 3600
        assert figures[("campus_mail_deliveries_late_total",)] <= 1


def test_what_is_gone_is_not_counted_any_more(watcher: Watcher, sender: Browser, mailroom: Mailroom) -> None:
    order_id = sender.order().json()["id"]
    assert watcher.figures()["campus_mail_orders", "queued"] == 1
    mailroom.move(order_id, "assigned")
    assert ("campus_mail_orders", "queued") not in watcher.figures()


def test_the_door_is_open_to_this_machine_alone_and_not_through_a_proxy(
    watcher: Watcher, anonymous: TestClient
) -> None:
    assert anonymous.get("/metrics").json()["code"] == "metrics_not_for_you"
    for name in ("X-Forwarded-For", "X-Forwarded-Proto", "Forwarded", "Via"):
        assert watcher.get("/metrics", headers={name: "1.1 proxy"}).status_code == 403, name


def test_with_a_token_it_is_the_token_that_counts_wherever_the_client_is(
    settings: Settings, clock: SteppedClock
) -> None:
    app = create_app(settings.model_copy(update={"metrics_token": SecretStr(TOKEN)}), clock)
    with TestClient(app, base_url=HERE) as elsewhere:
        here = Watcher(app, elsewhere)
        for client in (here, elsewhere):
            for wrong in ("", "Bearer ", f"Bearer {TOKEN}x", TOKEN, "Bearer tökén".encode()):
                assert client.get("/metrics", headers={"Authorization": wrong}).status_code == 403
            assert client.get("/metrics", headers={"Authorization": f"Bearer {TOKEN}"}).status_code == 200


@pytest.fixture
def logs_as_before() -> Iterator[None]:
    """A test that sets logging up puts it back."""
    root = logging.getLogger()
    handlers, level = root.handlers[:], root.level
    yield
    root.handlers[:] = handlers
    root.setLevel(level)


def test_each_answer_carries_an_id_and_so_does_every_line_of_the_log_that_comes_of_it(
    sender: Browser, logs_as_before: None, capsys: pytest.CaptureFixture[str]
) -> None:
    order_id = sender.order().json()["id"]
    set_up_logs("DEBUG", as_json=True)
    answer = sender.get(f"/api/v1/orders/{order_id}", headers={"X-Request-ID": "from-the-proxy-1"})
    assert answer.headers["X-Request-ID"] == "from-the-proxy-1"
    forged = sender.get("/api/v1/me", headers={"X-Request-ID": 'x" order="y'})
    assert len(forged.headers["X-Request-ID"]) == 16
    text = capsys.readouterr().err
    logged = [json.loads(line) for line in text.splitlines()]
    (line,) = [one for one in logged if one.get("request") == "from-the-proxy-1" and one["event"] == "answered"]
    assert (line["order"], line["status"], line["method"]) == (order_id, 200, "GET")
    assert "order=" not in text
