"""The tape plan as it comes out of the printer, and its drawing measured against the map file."""

import math
from pathlib import Path

import pypdfium2
import pytest
from typer.testing import CliRunner, Result

from maps import find_map, read_map
from maps.__main__ import cli
from maps.campus_map import FOLDER
from maps.drawing import Line, Page, Words
from maps.tape_plan import tape_pages

EXAMPLES = FOLDER.parent / "examples/maps"
MM_PER_POINT = 25.4 / 72
# Post a: bays to the north-east, with a dock, and to the west; the corridor leaves to the south.
ONE_CORNER = """
[[post]]
name = "a"
title = "Archive"
x_m = 3.0
y_m = 7.0
[[post.bay]]
bearing_deg = 50.0
dock = true
home = true
length_m = 1.2
[[post.bay]]
bearing_deg = 180.0

[[post]]
name = "b"
x_m = 3.0
y_m = 2.0
[[post.bay]]
bearing_deg = 0.0

[[corridor]]
ends = ["a", "b"]
length_m = 5.2
assumed = true
"""


def tape(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["tape", *arguments])


def words_of(path: Path) -> list[str]:
    with pypdfium2.PdfDocument(path) as document:
        return [page.get_textpage().get_text_bounded() for page in document]


@pytest.fixture
def pages(write_map) -> tuple[Page, ...]:
    return tape_pages(read_map(write_map(ONE_CORNER)))


def test_there_is_an_overview_and_a_page_for_each_post_with_bays(write_map, tmp_path):
    plan = tmp_path / "plan.pdf"
    result = tape(str(write_map(ONE_CORNER)), "--out", str(plan))
    assert (result.exit_code, "the campus, and 2 of 2 posts" in result.stdout) == (0, True)
    overview, archive, b = words_of(plan)
    assert "posts: 2 · corridors: 1 · bays: 3" in overview
    assert archive.startswith("Archive")
    assert "page 3 of 3" in b
    version = find_map(write_map(ONE_CORNER)).version
    assert all(f"map version {version}" in page for page in (overview, archive, b))


def test_an_assumed_length_is_marked_as_such(pages, write_map):
    assert "~5.2 m" in texts(pages[0])
    assert texts(pages[0])[-5:-2] == ["a – b", "5.20 m", "assumed"]
    assert any("the length is assumed" in text for text in texts(pages[0]))
    measured = tape_pages(read_map(write_map(ONE_CORNER.replace("assumed = true", ""))))
    assert not any("assumed" in text for page in measured for text in texts(page))


def test_each_line_has_its_bearing_the_angle_to_the_next_and_where_its_tape_ends(pages):
    """Clockwise from north: 50° from east is 40°. Chords of 1 m: 2 sin 70°, 2 sin 45°, 2 sin 65°."""
    rows = rows_of(pages[1], "line")
    assert rows == [
        ["A", "a_bay1, home, dock", "40°", "140° to B", "1.879 m", "ends at 1.20 m, dock 1.70 m"],
        ["B", "corridor to b", "180°", "90° to C", "1.414 m", "5.20 m (assumed)"],
        ["C", "a_bay2", "270°", "130° to A", "1.813 m", "ends at 1.00 m"],
    ]


def test_each_sheet_has_its_place_as_seen_from_the_post(pages):
    rows = rows_of(pages[1], "sheet")
    assert rows == [
        ["1", "a", "A", "0.60 m", "0.35 m to the right", "310°"],
        ["2", "a_bay1", "A", "1.10 m", "0.35 m to the left", "130°"],
        ["3", "a_bay1", "A", "1.70 m", "0.35 m to the left", "130°"],
        ["4", "a", "B", "0.60 m", "0.35 m to the right", "90°"],
        ["5", "a", "C", "0.60 m", "0.35 m to the right", "180°"],
        ["6", "a_bay2", "C", "0.90 m", "0.35 m to the left", "0°"],
    ]


def test_tape_and_dock_are_drawn_to_scale_and_at_their_angles(pages):
    scale = float(next(text for text in texts(pages[1]) if "(1 : " in text).split()[-1].rstrip(")"))
    thick = [line for line in lines(pages[1]) if line.width_mm == pytest.approx(max(0.8, 24 / scale))]
    drawn = {round(bearing_deg(line)): length_m(line, scale) for line in thick}
    assert drawn == {40: pytest.approx(1.2), 180: pytest.approx(0.95), 270: pytest.approx(1.0)}
    (to_dock,) = [line for line in lines(pages[1]) if line.dashed]
    assert (round(bearing_deg(to_dock)), length_m(to_dock, scale)) == (40, pytest.approx(0.5))
    assert (thick[0].x0_mm, thick[0].y0_mm) == pytest.approx((thick[1].x0_mm, thick[1].y0_mm)), "from the same post"


def test_sheets_are_drawn_where_the_map_has_them(pages, write_map):
    """Blue strokes of 148 mm; their distance from the post, which all tape begins at."""
    scale = float(next(text for text in texts(pages[1]) if "(1 : " in text).split()[-1].rstrip(")"))
    post = next(line for line in lines(pages[1]) if line.width_mm == pytest.approx(max(0.8, 24 / scale)))
    sheets = [line for line in lines(pages[1]) if line.colour == "#1a5fa8" and line.width_mm == 1.0]
    assert {round(length_m(line, scale), 3) for line in sheets} == {0.148}
    middles = [((line.x0_mm + line.x1_mm) / 2, (line.y0_mm + line.y1_mm) / 2) for line in sheets]
    drawn = sorted(((x - post.x0_mm) * scale / 1000 + 3.0, (post.y0_mm - y) * scale / 1000 + 7.0) for x, y in middles)
    a = read_map(write_map(ONE_CORNER)).post("a")
    markers = [*a.markers, *(marker for bay in a.spurs for marker in bay.markers)]
    assert [x_m for x_m, _ in drawn] == pytest.approx(sorted(marker.x_m for marker in markers))
    assert sorted(y_m for _, y_m in drawn) == pytest.approx(sorted(marker.y_m for marker in markers))


def test_everything_lies_on_the_paper(tmp_path):
    """Six lines at a post are the most that fit; a long title; more corridors than a page has rows."""
    for text in (_crowded(), _long_row(150)):
        path, plan = tmp_path / "campus.toml", tmp_path / "plan.pdf"
        path.write_text(text, encoding="utf-8")
        assert tape(str(path), "--out", str(plan)).exit_code == 0
        with pypdfium2.PdfDocument(plan) as document:
            for page in document:
                words = page.get_textpage()
                boxes = [words.get_rect(number) for number in range(words.count_rects())]
                assert min(left for left, *_ in boxes) * MM_PER_POINT > 14
                assert max(right for _, _, right, _ in boxes) * MM_PER_POINT < 196
                # Only the foot of the page lies lower than 12 mm above the edge.
                assert sum(low * MM_PER_POINT < 12 for _, low, _, _ in boxes) == 2


def test_every_drawing_lies_in_its_frame(write_map):
    """A spur to the west and a dock to the north-east reach farther than the posts of the campus."""
    for page in (*tape_pages(read_map(write_map(ONE_CORNER))), *tape_pages(find_map("carleton"))):
        frame = [line for line in lines(page) if line.width_mm == 0.2 and line.colour == "#b8b8b8"]
        left, right = min(line.x0_mm for line in frame), max(line.x0_mm for line in frame)
        top, bottom = min(line.y0_mm for line in frame), max(line.y0_mm for line in frame)
        drawn = [line for line in lines(page) if top < line.y0_mm < bottom]
        ends = [end for line in drawn for end in ((line.x0_mm, line.y0_mm), (line.x1_mm, line.y1_mm))]
        assert len(ends) > 10
        assert all(left <= x <= right and top <= y <= bottom for x, y in ends)


def test_no_corridor_of_a_large_campus_is_left_out(tmp_path):
    (tmp_path / "campus.toml").write_text(_long_row(150), encoding="utf-8")
    assert tape(str(tmp_path / "campus.toml"), "--out", str(tmp_path / "plan.pdf")).exit_code == 0
    words = " ".join(words_of(tmp_path / "plan.pdf"))
    assert all(f"p{n} – p{n + 1}" in words for n in range(149))


def test_a_map_without_bays_has_an_overview_alone(tmp_path):
    result = tape(str(EXAMPLES / "square.toml"), "--out", str(tmp_path / "plan.pdf"))
    assert "the campus, and 0 of 4 posts" in result.stdout
    assert len(words_of(tmp_path / "plan.pdf")) == 1


def test_a_plan_that_cannot_be_written_is_named(tmp_path):
    result = tape(str(EXAMPLES / "square.toml"), "--out", str(tmp_path / "nowhere" / "plan.pdf"))
    assert (result.exit_code, "the plan cannot be written there" in result.stderr) == (2, True)


# Reading a page


def texts(page: Page) -> list[str]:
    return [shape.text for shape in page.shapes if isinstance(shape, Words)]


def lines(page: Page) -> list[Line]:
    return [shape for shape in page.shapes if isinstance(shape, Line)]


def rows_of(page: Page, heading: str) -> list[list[str]]:
    """The table whose first heading is this, row by row as it is printed."""
    words = [shape for shape in page.shapes if isinstance(shape, Words)]
    begin = next(n for n, shape in enumerate(words) if shape.text == heading)
    rows: list[list[str]] = []
    for before, shape in zip(words[begin:], words[begin + 1 :], strict=False):
        if shape.baseline_mm != before.baseline_mm:
            if shape.baseline_mm - before.baseline_mm > 6:
                break
            rows.append([])
        if rows:
            rows[-1].append(shape.text)
    return rows


def length_m(line: Line, scale: float) -> float:
    return math.hypot(line.x1_mm - line.x0_mm, line.y1_mm - line.y0_mm) * scale / 1000


def bearing_deg(line: Line) -> float:
    return math.degrees(math.atan2(line.x1_mm - line.x0_mm, line.y0_mm - line.y1_mm)) % 360


def _crowded() -> str:
    bays = "".join(f"[[post.bay]]\nbearing_deg = {bearing}\n" for bearing in (120, 180, 240, 300))
    title = "Archive of the faculty, in the basement, behind the second door on the left"
    bays += "[[post.bay]]\nbearing_deg = 60\ndock = true\n"
    a = f'[[post]]\nname = "a"\ntitle = "{title}"\nx_m = 0\ny_m = 0\n{bays}'
    b = '[[post]]\nname = "b"\nx_m = 9\ny_m = 0\n'
    return f'name = "crowd"\ntitle = "Crowd"\n{a}{b}[[corridor]]\nends = ["a", "b"]\n'


def _long_row(posts: int) -> str:
    places = "".join(f'[[post]]\nname = "p{n}"\nx_m = {4 * (n % 12)}\ny_m = {4 * (n // 12)}\n' for n in range(posts))
    ways = "".join(f'[[corridor]]\nends = ["p{n}", "p{n + 1}"]\n' for n in range(posts - 1))
    return f'name = "row"\ntitle = "Row"\n{places}{ways}'
