"""Letting go by hand: what does not come back is asked about first if the clock may be wrong."""

from datetime import UTC, datetime, timedelta

import pytest

from app.core.settings import Settings
from tests.app.cli.conftest import Run
from tests.app.conftest import sqlite_alone
from tests.app.test_when_the_clock_leaps import AWAY, asked, ordered


@sqlite_alone
@pytest.mark.parametrize("age", [timedelta(days=500), timedelta(days=-1)])
def test_a_clock_that_no_record_confirms_lets_go_of_nothing_unless_an_operator_says_so(
    settings: Settings, run: Run, age: timedelta
) -> None:
    ordered(settings.model_copy(update=AWAY), datetime.now(UTC) - age)
    refused = run("retain")
    assert (refused.exit_code, "--clock-is-right" in refused.output) == (2, True)
    assert asked(settings.data, "select count(*) from sessions") == [(1,)]
    assert run("retain", "--clock-is-right").exit_code == 0
    assert asked(settings.data, "select count(*) from sessions") == [(0 if age.days > 0 else 1,)]
