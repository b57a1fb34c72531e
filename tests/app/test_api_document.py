"""The OpenAPI document is good enough to be tested against: what it promises is what is answered."""

from typing import Any

import pytest
import schemathesis
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.specs.openapi.checks import positive_data_acceptance

from tests.app.conftest import Browser, Served

NEVER_ENDS = "/api/v1/live"
EXAMPLES = 12


@pytest.fixture
def operations(served: Served) -> list[Any]:
    """Every operation of the document of the served application, but for the stream, which has tests of its own."""
    document = schemathesis.openapi.from_url(f"{served.url}/api/v1/openapi.json")
    return [one.ok() for one in document.exclude(path=NEVER_ENDS).get_all_operations()]


def test_answers_are_as_documented(operations: list[Any], sender: Browser) -> None:
    assert len(operations) > 15
    given_by_everybody = {"headers": {"Sec-Fetch-Site": "same-origin"}, "cookies": dict(sender.cookies)}

    for operation in operations:

        @given(case=operation.as_strategy())
        @settings(
            max_examples=EXAMPLES, derandomize=True, suppress_health_check=list(HealthCheck), phases=[Phase.generate]
        )
        def answers_as_documented(case: Any) -> None:
            # A well-formed wish may still name an unknown post or address: 422, and documented.
            case.call_and_validate(excluded_checks=[positive_data_acceptance], **given_by_everybody)

        answers_as_documented()


def test_the_document_can_describe_an_event_stream(served: Served, sender: Browser) -> None:
    document = sender.get("/api/v1/openapi.json").json()
    assert document["openapi"] == "3.2.0"
    assert "text/event-stream" in document["paths"][NEVER_ENDS]["get"]["responses"]["200"]["content"]
