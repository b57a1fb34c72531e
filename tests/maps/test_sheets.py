"""Marker sheets as they come out of the printer: rendered by another program, measured and read by the real decoder."""

import re
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np
import pypdfium2
import pytest
import zxingcpp
from typer.testing import CliRunner, Result

from maps import builtin_map
from maps.__main__ import cli
from maps.campus_map import FOLDER
from maps.drawing import Square, as_pdf, as_svg
from maps.sheets import CODE_LEFT_MM, CODE_TOP_MM, PAGE_HEIGHT_MM, PAGE_WIDTH_MM, marker_page, places_with_sheets
from maps.tags import tag_numbers
from robot.drivers.camera.april_tags import TagDetector
from robot.drivers.camera.marker_reader import MarkerReader
from robot.drivers.camera.qr_decoders import read_with_opencv

TRACK = builtin_map("test_track")
PLACES = places_with_sheets(TRACK, TRACK.posts.values())
EXAMPLES = FOLDER.parent / "examples/maps"
BUILDINGS, SQUARE = EXAMPLES / "two_buildings.toml", EXAMPLES / "square.toml"
PX_PER_MM = 6
POINTS_PER_MM = 72 / 25.4


def run(*arguments: str) -> Result:
    return CliRunner().invoke(cli, ["markers", *arguments])


def paper(path) -> list[np.ndarray]:
    """Every page as a grey picture with 6 pixels a millimetre."""
    with pypdfium2.PdfDocument(path) as document:
        for page in document:
            width_mm, height_mm = (size / POINTS_PER_MM for size in page.get_size())
            assert (width_mm, height_mm) == pytest.approx((148, 210), abs=0.01), "A5"
        return [page.render(scale=PX_PER_MM / POINTS_PER_MM, grayscale=True).to_numpy().squeeze() for page in document]


@pytest.fixture(scope="module")
def printed(tmp_path_factory) -> list[np.ndarray]:
    folder = tmp_path_factory.mktemp("sheets")
    result = run("test_track", "--out", str(folder), "--april-tags")
    assert result.exit_code == 0
    assert "27 sheets for 5 posts and 8 bays" in result.stdout
    return paper(folder / "test_track.pdf")


def test_there_is_a_page_that_explains_and_one_for_each_marker(printed):
    read = [[code.text for code in zxingcpp.read_barcodes(page)] for page in printed]
    expected = [[place.name] for place in PLACES for _ in place.markers]
    assert read == [[], *expected]


def test_a_bay_has_sheets_as_a_post_has(tmp_path):
    assert run(str(BUILDINGS), "--post", "library", "--post", "workshop", "--out", str(tmp_path)).exit_code == 0
    read = [[code.text for code in zxingcpp.read_barcodes(page)] for page in paper(tmp_path / "two_buildings.pdf")]
    counted = Counter(name for names in read for name in names)
    # library: an approach from the corridor and from each of two bays; workshop: the same, and a docked robot's.
    assert counted == {
        "library": 3,
        "library_bay1": 1,
        "library_bay2": 1,
        "workshop": 3,
        "workshop_bay1": 2,
        "workshop_bay2": 1,
    }
    with pypdfium2.PdfDocument(tmp_path / "two_buildings.pdf") as document:
        words = [page.get_textpage().get_text_bounded() for page in document]
    assert "600 mm before a post with bays" in words[0]
    assert "100 mm before the end of a bay" in words[0]
    assert "without bays" not in words[0]
    assert "Library, loading bay, bay 1" in words[4]
    assert "library_bay1 · sheet 1 of 1" in words[4]


def test_a_sheet_says_how_many_of_it_its_bay_needs(tmp_path):
    assert run(str(BUILDINGS), "--post", "workshop", "--format", "svg", "--out", str(tmp_path)).exit_code == 0
    assert "workshop_bay1 · 2 of these at this bay" in (tmp_path / "workshop_bay1.svg").read_text(encoding="utf-8")
    assert "workshop · 3 of these at this post" in (tmp_path / "workshop.svg").read_text(encoding="utf-8")


def test_where_no_post_has_bays_the_sheets_hang_nearer(tmp_path):
    assert run(str(SQUARE), "--out", str(tmp_path)).exit_code == 0
    with pypdfium2.PdfDocument(tmp_path / "square.pdf") as document:
        words = document[0].get_textpage().get_text_bounded()
    assert "300 mm before a post without bays" in words
    assert "600 mm" not in words


@pytest.mark.parametrize("campus", ["test_track", "carleton", str(BUILDINGS)])
def test_no_word_runs_off_the_paper(campus, tmp_path):
    assert run(campus, "--out", str(tmp_path), "--april-tags").exit_code == 0
    with pypdfium2.PdfDocument(tmp_path / f"{Path(campus).stem}.pdf") as document:
        for page in document:
            words = page.get_textpage()
            boxes = [words.get_rect(number) for number in range(words.count_rects())]
            assert boxes
            assert min(left for left, *_ in boxes) > 10
            assert max(right for _, _, right, _ in boxes) < PAGE_WIDTH_MM * POINTS_PER_MM - 10


def test_the_code_is_80_mm_wide_and_stands_where_the_robot_expects_it(printed):
    for page in printed[1:]:
        (code,) = zxingcpp.read_barcodes(page)
        # Ink between the first row and the ruler, left and right of nothing else: the code itself.
        ink = (
            page[CODE_TOP_MM * PX_PER_MM - 6 : (CODE_TOP_MM + 80) * PX_PER_MM + 6, 20 * PX_PER_MM : -20 * PX_PER_MM]
            < 128
        )
        rows, columns = np.nonzero(ink)
        assert np.ptp(columns) + 1 == pytest.approx(80 * PX_PER_MM, abs=2)
        assert np.ptp(rows) + 1 == pytest.approx(80 * PX_PER_MM, abs=2)
        assert columns.min() + 20 * PX_PER_MM == pytest.approx(CODE_LEFT_MM * PX_PER_MM, abs=2)
        assert (code.ec_level, code.extra["Version"]) == ("H", "1" if len(code.text) <= 7 else "2")


def test_the_robots_other_decoder_reads_it_from_the_paper_too(printed):
    small = cv2.resize(printed[1], None, fx=0.3, fy=0.3, interpolation=cv2.INTER_AREA)
    assert [code.text for code in read_with_opencv(small, budget_s=2.0)] == ["post1"]


def test_the_tag_on_the_paper_is_40_mm_and_says_the_same_post(printed):
    detector = TagDetector(tag_numbers(TRACK))
    names = [place.name for place in PLACES for _ in place.markers]
    for page, name in zip(printed[1:], names, strict=True):
        (tag,) = detector.read(cv2.resize(page, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA))
        (x0, y0), (x1, y1), *_ = tag.corners
        assert tag.text == name
        assert np.hypot(x1 - x0, y1 - y0) == pytest.approx(40 * PX_PER_MM / 2, abs=2)


def test_a_torn_code_is_still_read_by_its_tag(printed):
    """A person tore the upper half away; the robot stands before what is left."""
    names = [place.name for place in PLACES for _ in place.markers]
    frame = cv2.resize(printed[1 + names.index("post3")], None, fx=0.28, fy=0.28, interpolation=cv2.INTER_AREA)
    frame = np.pad(frame, ((60, 60), (180, 180)), constant_values=120)[:480, :640].copy()
    frame[: 60 + int(95 * PX_PER_MM * 0.28)] = 120
    with_tags = MarkerReader(TRACK.posts, tags=tag_numbers(TRACK))
    assert MarkerReader(TRACK.posts).look(frame, 0.0) == ()
    assert [sighting.text for sighting in with_tags.look(frame, 0.0)] == ["post3"]


def test_svg_is_one_file_for_each_post_with_the_same_drawing(tmp_path):
    assert run("test_track", "--format", "svg", "--out", str(tmp_path)).exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(f"{place.name}.svg" for place in PLACES)
    root = ElementTree.parse(tmp_path / "post3.svg").getroot()  # noqa: S314  our own file
    assert (root.get("width"), root.get("height")) == (f"{PAGE_WIDTH_MM}mm", f"{PAGE_HEIGHT_MM}mm")
    path = root.find("{http://www.w3.org/2000/svg}path")
    assert path is not None
    drawn = [
        Square(*map(float, four)) for four in re.findall(r"M([\d.]+) ([\d.]+)h([\d.]+)v([\d.]+)", path.get("d", ""))
    ]
    picture = np.full((PAGE_HEIGHT_MM * PX_PER_MM, PAGE_WIDTH_MM * PX_PER_MM), 255, np.uint8)
    for square in drawn:
        left, top = square.left_mm * PX_PER_MM, square.top_mm * PX_PER_MM
        picture[
            round(top) : round(top + square.height_mm * PX_PER_MM),
            round(left) : round(left + square.width_mm * PX_PER_MM),
        ] = 0
    assert [code.text for code in zxingcpp.read_barcodes(picture)] == ["post3"]
    assert min(square.left_mm for square in drawn) == CODE_LEFT_MM
    assert max(square.left_mm + square.width_mm for square in drawn) == pytest.approx(CODE_LEFT_MM + 80, abs=0.001)


def test_one_post_alone_and_an_unknown_one(tmp_path):
    assert run("carleton", "--post", "uc", "--format", "svg", "--out", str(tmp_path)).exit_code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["uc.svg", "uc_bay1.svg", "uc_bay2.svg"]
    wrong = run("carleton", "--post", "uk", "--out", str(tmp_path))
    assert (wrong.exit_code, "Did you mean 'uc'" in wrong.stderr) == (2, True)


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    result = run("test_track", "--out", str(tmp_path / "file"))
    assert result.exit_code == 2
    assert "cannot be written there" in result.stderr


def test_titles_with_accents_and_signs_of_xml_come_out_whole():
    import dataclasses

    post = dataclasses.replace(TRACK.post("post1"), title="Nideyinàn <Café> & Büro")
    page = marker_page(post)
    words = [text.text for text in ElementTree.fromstring(as_svg(page)).iter("{http://www.w3.org/2000/svg}text")]  # noqa: S314
    assert words[0] == "Nideyinàn <Café> & Büro"
    with pypdfium2.PdfDocument(as_pdf((page,), "Markers")) as document:
        assert "Nideyinàn <Café> & Büro" in document[0].get_textpage().get_text_bounded()
