"""The reference names everything that a person can set."""

from pathlib import Path

import pytest

from docs.site.robot_pages import robot_settings
from robot.core.config import load_settings
from robot.core.settings_file import SettingRow, rows

MANUAL = (Path(__file__).parents[2] / "docs" / "reference" / "robot.md").read_text("utf-8")
SETTINGS = robot_settings().splitlines()


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: row.key)
def test_every_setting_is_in_the_reference_with_its_default_its_meaning_and_its_range(row: SettingRow) -> None:
    default = "" if row.default is None else "`" + row.default.strip('"') + "`"
    about = f"{row.about} ({row.range})" if row.range else row.about
    wanted = f"| `{row.key}` | {default} | {about} |"
    assert wanted in SETTINGS


def test_the_manuals_example_is_accepted(tmp_path: Path) -> None:
    example = MANUAL.split("```toml\n")[1].split("```")[0]
    path = tmp_path / "robot.toml"
    path.write_text(example)
    assert load_settings(path, {}).map == "carleton"
