"""A scenario file says what is wrong with it, where, and what was probably meant."""

from pathlib import Path

import pytest

from docs.site.robot_pages import scenario_keys
from robot.scenarios.errors import ScenarioError
from robot.scenarios.loading import keys, read_scenario

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "how-to" / "write-a-scenario.md").read_text("utf-8")
KEYS = scenario_keys()
EXAMPLES = sorted((ROOT / "examples" / "scenarios").glob("*.toml"))


def refusal(tmp_path: Path, text: str) -> str:
    path = tmp_path / "wrong.toml"
    path.write_text(text)
    with pytest.raises(ScenarioError) as refused:
        read_scenario(path)
    return str(refused.value)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("sead = 3", "sead: there is no such key. Did you mean 'seed'?"),
        ("[[order]]\nid = 'o'\nform = 'post1'\nto = 'post4'", "order.1.from: Field required"),
        ("[[robot]]\nname = 'r1'\nbatery = 0.5", "robot.1.batery: there is no such key. Did you mean 'robot.battery'?"),
        ("[noise]\nflip = 2", "noise.flip: Input should be less than or equal to 1"),
        ("[[order]]\nid = 'o'\nfrom = 'post1'\nto = 'pots4'", "order.to: there is no 'pots4'. Did you mean 'post4'?"),
        ("[map]\nname = 'atlantis'", "no map of this name ships"),
        ("[[fault]]\nswitch = 'camera_ded'", "Did you mean 'camera_dead'?"),
        ("[[fault]]\nswitch = 'camera_dead'\nvalue = 3", "camera_dead: 3 does not fit; expected true or false"),
        ("[[stander]]\ncorridor = 'post1-post3'", "stander.corridor: there is no 'post1-post3'"),
        ("[[stander]]\nfrom_s = 3", "stander: the place is missing. Give at or corridor."),
        ("[[robot]]\nname = 'r1'\nstart = 'post9'", "robot.start: A robot cannot start at 'post9'"),
        ("[[robot]]\nname = 'r1'\nhome = 'post2'", "robot.home: post2 is no home on this map. There are: "),
        ("[[message]]\nsay = 'cancel'\norder = 'o9'", "message.order: there is no 'o9'"),
        ("[[deed]]\ndo = 'show_code'", "deed.text: no text is given to show. Give one, as text = 'post4'."),
        ("[expect]\ndelivered = ['o9']", "expect.delivered: there is no 'o9'"),
        ("seed = ", "is not TOML"),
    ],
)
def test_what_is_wrong_is_named_with_its_place_and_the_nearest_spelling(tmp_path, text, sentence):
    assert sentence in refusal(tmp_path, text)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ScenarioError, match=r"none.toml: file: cannot be read: No such file"):
        read_scenario(tmp_path / "none.toml")


@pytest.mark.parametrize("key", sorted(keys()))
def test_every_key_is_on_the_page_with_its_meaning(key):
    rows = [line for line in KEYS.splitlines() if line.startswith(f"| `{key}` |")]
    assert [row for row in rows if keys()[key].replace("|", "\\|") in row]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_is_a_scenario_and_on_the_page(path):
    assert read_scenario(path).about
    assert path.name in PAGE
