"""docs/reference/agentspeak.md against the interpreter: nothing is missing, nothing is invented."""

import re
from pathlib import Path

import pytest

from bdi import Agent, AgentSpeakSyntaxError, parse_program
from bdi.builtin import ACTIONS, FUNCTIONS, NOT_SUPPORTED, Definition
from bdi.builtin.kinds import counts
from bdi.reasoning.performatives import PERFORMATIVES

ROOT = Path(__file__).parents[2]
REFERENCE = ROOT / "docs" / "reference"
PAGE = (REFERENCE / "agentspeak.md").read_text()
DIFFERENCES = (REFERENCE / "agentspeak-differences.md").read_text().partition("## What differs from Jason")[2]
CODE = re.compile(r"`([^`]+)`")
STATUS = re.compile(r"same|ours|differs: ([\w-]+)|not supported: .+")
CELLS = re.compile(r"(?<!\\)\|")

# Jason 3.3's own internal actions and functions; what makes sense only with Java is left out.
JASONS = """
.abolish .add_annot .add_nested_source .add_plan .all_names .asserta .assertz .at .atom .belief .broadcast .clone
.concat .copy_term .count .create_agent .current_intention .date .delete .desire .df_register .df_deregister .df_search
.df_subscribe .difference .done .drop_all_desires .drop_all_events .drop_all_intentions .drop_desire .drop_event
.drop_future_intention .drop_intention .empty .eval .fail .fail_goal .findall .foreach .fork .get_src_info .ground
.if_then_else .intend .intention .intersection .join .kill_agent .length .list .list_files .list_plans
.list_rules .literal .log .loop .lower_case .max .member .min .my_name
.nano_time .nth .number .plan_label .prefix .print .printf .println .puts .print_unifier
.random .range .relevant_plan .relevant_plans .relevant_rules .remove_plan .remove_source_annot .rename_apart .replace
.resume .reverse .save_agent .send .set_random_seed .setof .shuffle .sort .stopMAS .string .structure .sublist
.substring .succeed_goal .suffix .suspend .suspended .term2string .time .type .union .upper_case .verbose .wait
.map.create .map.put .map.get .map.remove .map.key .map.value .map.copy .map.clear .set.create .set.add .set.add_all
.set.remove .set.union .set.difference .set.intersection .set.copy .set.clear .set.to_list .queue.create .queue.add
.queue.add_all .queue.head .queue.remove .queue.copy .queue.clear math.abs math.acos math.asin math.atan math.average
math.ceil math.cos math.e math.floor math.log math.max math.mean math.median math.min math.pi math.random math.round
math.sin math.sqrt math.std_dev math.sum math.tan
"""


def rows(*titles: str) -> list[list[str]]:
    """The cells of every row of the tables under these headings, headings below them included."""
    found = []
    for title in titles:
        level = title.split()[0]
        section = PAGE.partition(f"\n{title}\n")[2]
        assert section, title
        section = re.split(rf"\n#{{1,{len(level)}}} ", section)[0]
        lines = [line for line in section.splitlines() if line.startswith("| `")]
        found += [[cell.strip().replace("\\|", "|") for cell in CELLS.split(line)[1:-1]] for line in lines]
    return found


ALL_TABLES = [line for line in PAGE.splitlines() if line.startswith("## ")]


def names(title: str) -> list[str]:
    """Return the names in the first cells of a table, without arguments."""
    return [code.partition("(")[0] for row in rows(title) for code in CODE.findall(row[0])]


def test_every_internal_action_has_one_row() -> None:
    listed = [CODE.findall(row[0])[0].partition("(")[0] for row in rows("## Internal actions")]
    assert sorted(listed) == sorted(ACTIONS)


def test_every_function_has_one_row() -> None:
    assert sorted(names("## Functions")) == sorted(FUNCTIONS)


def test_what_is_not_supported_is_listed_with_its_reason() -> None:
    assert {CODE.findall(row[0])[0]: row[1] for row in rows("## Not supported")} == NOT_SUPPORTED


def test_everything_that_jason_has_is_listed() -> None:
    listed = {*names("## Internal actions"), *names("## Functions"), *names("## Not supported")}
    assert [name for name in JASONS.split() if name not in listed] == []


@pytest.mark.parametrize(
    ("title", "table"), [("## Internal actions", ACTIONS), ("## Functions", FUNCTIONS)], ids=["actions", "functions"]
)
def test_the_arguments_are_as_many_as_the_table_says(title: str, table: dict[str, Definition]) -> None:
    said = {CODE.findall(row[0])[0].partition("(")[0]: ranges(CODE.findall(row[0])) for row in rows(title)}
    assert said == {name: counts(definition.takes) for name, definition in table.items()}


def ranges(calls: list[str]) -> tuple[int, int | None]:
    """Of `.f(a,[b])` and `.f(a,b,c)`: from 1 to 3 arguments."""
    counted = [count(call) for call in calls]
    most = [high for _, high in counted]
    return min(low for low, _ in counted), None if None in most else max(high for high in most if high is not None)


def count(call: str) -> tuple[int, int | None]:
    inside = call.partition("(")[2].removesuffix(")")
    arguments = inside.split(",") if inside else []
    needed = [each for each in arguments if not each.startswith("[") and "…" not in each]
    return len(needed), None if "…" in inside else len(arguments)


def test_every_performative_has_one_row() -> None:
    assert sorted(names("## Performatives")) == sorted(PERFORMATIVES)


def test_every_row_says_what_jason_makes_of_it_and_every_difference_is_explained() -> None:
    for title in ALL_TABLES:
        if title == "## Not supported":
            continue
        for row in rows(title):
            status = STATUS.fullmatch(row[-1])
            assert status, row
            assert not status[1] or f"| `{status[1]}` |" in DIFFERENCES, row


def test_every_error_is_listed_and_every_error_listed_exists() -> None:
    sources = "\n".join(path.read_text() for path in (ROOT / "bdi").rglob("*.py"))
    listed = names("## Error atoms")
    raised = re.findall(r'StepFailed\(\s*"(\w+)"', sources)
    assert sorted(set(raised) - set(listed)) == []
    assert [name for name in listed if f'"{name}"' not in sources] == []


@pytest.mark.parametrize("form", [CODE.findall(row[0])[0] for row in rows("## Clauses of a program")])
def test_a_clause_can_be_read(form: str) -> None:
    Agent(parse_program(form))


@pytest.mark.parametrize("trigger", [CODE.findall(row[0])[0] for row in rows("## Triggers")])
def test_a_trigger_can_be_read(trigger: str) -> None:
    Agent(parse_program(f"{trigger} <- a."))


@pytest.mark.parametrize("step", [CODE.findall(row[0])[0] for row in rows("## Steps of a plan")])
def test_a_step_can_be_read(step: str) -> None:
    Agent(parse_program(f"+!g <- {step}; done."))


@pytest.mark.parametrize("form", [CODE.findall(row[0])[0] for row in rows("## Terms and operators")])
def test_a_term_can_be_read(form: str) -> None:
    wanted = f"+!g : {form} <- a." if any(sign in form for sign in "<=") else f"+!g <- a({form})."
    Agent(parse_program(wanted))


@pytest.mark.parametrize("directive", [CODE.findall(row[0])[0] for row in rows("## Directives")])
def test_a_directive_can_be_read(directive: str) -> None:
    try:
        parse_program(directive + " r(1,2).")
    except AgentSpeakSyntaxError as error:  # pragma: no cover -- only where the page is wrong
        pytest.fail(str(error))
    except Exception as error:
        assert "safety.asl" in str(error)  # there is no such file here: the directive was understood
