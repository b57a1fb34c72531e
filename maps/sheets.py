"""Marker sheets for the printer: an A5 page for each marker of each post, its codes at the size that robots expect.

Here a place is a post or one of its bays: a bay is a place of the track like a post.
"""

from collections.abc import Iterable, Iterator
from functools import cache

import segno

from maps.bays import (
    MARKER_BEFORE_BAY_M,
    MARKER_BEFORE_CROSSING_M,
    MARKER_BEFORE_PLACE_M,
    MARKER_BESIDE_LINE_M,
    MARKER_SIZE_M,
)
from maps.campus_map import CampusMap, Post
from maps.drawing import Line, Page, Square, Words, as_svg
from maps.tags import TAG_SIZE_MM

PAGE_WIDTH_MM = 148
PAGE_HEIGHT_MM = 210
CODE_LEFT_MM, CODE_TOP_MM = 34, 50
TAG_LEFT_MM, TAG_TOP_MM = (PAGE_WIDTH_MM - TAG_SIZE_MM) / 2, 145.5
TAG_CELLS = 8
CUT_MM = 8.0
LENS_HEIGHT_MM = 254
WIDEST_TITLE_MM = 210
"""A title of so many millimetres, if each letter were as wide as high, still fits: on average it is 0.6 of that."""
MOST_IN_3_COLUMNS = 42


def marker_code(post: str) -> segno.QRCode:
    """The QR code that says the post's name: error correction H, so that it can lose 30 % to dirt."""
    return segno.make(post, error="h", micro=False, boost_error=False)


@cache
def tag_cells(number: int) -> tuple[tuple[bool, ...], ...]:
    """The tag's 8 × 8 cells with its black border; True is ink."""
    import cv2

    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    picture = cv2.aruco.generateImageMarker(family, number, TAG_CELLS)
    return tuple(tuple(bool(cell < 128) for cell in row) for row in picture)


# The drawing


def marker_page(place: Post, number: int | None = None, april_tag: bool = False) -> Page:
    """The page of the place's marker `number`, or of any: all of them hold the same."""
    size_mm = MARKER_SIZE_M * 1000
    squares = tuple(_cells(marker_code(place.name).matrix, CODE_LEFT_MM, CODE_TOP_MM, size_mm))
    if april_tag and place.tag is not None:
        squares += tuple(_cells(tag_cells(place.tag), TAG_LEFT_MM, TAG_TOP_MM, TAG_SIZE_MM))
    middle, of = PAGE_WIDTH_MM / 2, len(place.markers)
    kind = "bay" if place.bay_of else "post"
    which = f"{of} of these at this {kind}" if number is None else f"sheet {number} of {of}"
    ruler = Line(CODE_LEFT_MM, 191.5, CODE_LEFT_MM + size_mm, 191.5)
    words = (
        Words(middle, 24, min(10.0, WIDEST_TITLE_MM / max(len(place.title), 1)), place.title),
        Words(middle, 33, 5, f"{place.name} · {which}"),
        Words(middle, 196, 3.2, f"This line is {size_mm:g} mm long when printed at 100 %."),
        Words(middle, 200.5, 3.2, f"Middle of the code {LENS_HEIGHT_MM} mm above the floor, facing the line, upright."),
    )
    return _page((*squares, *_cut_lines(), ruler, *words))


def explaining_page(campus: CampusMap, places: tuple[Post, ...], april_tags: bool) -> Page:
    """Instructions for the pages that follow, on paper."""
    sheets = sum(len(place.markers) for place in places)
    sentences = (
        f"{sheets} sheets for {count_of(places)} of the map {campus.name}.",
        "",
        "1. Print at 100 % (“actual size”), on white paper that does not shine.",
        f"2. Measure the line below the code: it must be {MARKER_SIZE_M * 1000:g} mm.",
        "3. Cut at the marks in the corners. Leave the white round the code.",
        f"4. Mount it upright, the middle of the code {LENS_HEIGHT_MM} mm above the floor,",
        "    facing the line, on the LEFT of a robot that arrives:",
        *_where_to_mount(campus, places),
        "5. A dock has one more, abreast of the docked robot.",
        "6. All sheets of a post or bay are the same; each approach needs one.",
        "7. Wipe them now and then. Replace what is torn.",
        *(
            ("", "The square below the code is an AprilTag: it is read", "where the code is torn.")
            if april_tags
            else ()
        ),
    )
    head = Words(PAGE_WIDTH_MM / 2, 24, 8, campus.title)
    rows = (Words(14, 38 + 6.5 * row, 3.6, text, "left") for row, text in enumerate(sentences) if text)
    counts = [f"{place.name}: {len(place.markers)}" for place in places]
    last_mm = 38 + 6.5 * (len(sentences) + 1)
    columns = 3 if len(counts) <= MOST_IN_3_COLUMNS else 4
    width_mm, size_mm = (PAGE_WIDTH_MM - 28) / columns, 3.2 if columns == 3 else 2.6
    row_mm = min(5.0, (PAGE_HEIGHT_MM - 10 - last_mm) / -(-len(counts) // columns))
    table = (
        Words(14 + width_mm * (n % columns), last_mm + row_mm * (n // columns), size_mm, text, "left")
        for n, text in enumerate(counts)
    )
    return _page((head, *rows, *table))


def count_of(places: tuple[Post, ...]) -> str:
    """Return "2 posts and 3 bays"."""
    bays = sum(place.bay_of is not None for place in places)
    posts = len(places) - bays
    return f"{posts} posts" + (f" and {bays} bays" if bays else "")


def _where_to_mount(campus: CampusMap, places: tuple[Post, ...]) -> Iterator[str]:
    beside = f"{MARKER_BESIDE_LINE_M * 1000:g} mm beside the line"
    posts = [place for place in places if not place.bay_of]
    if any(not campus.track.bays_of(post.name) for post in posts):
        yield f"    {MARKER_BEFORE_PLACE_M * 1000:g} mm before a post without bays, {beside};"
    if any(campus.track.bays_of(post.name) for post in posts):
        yield f"    {MARKER_BEFORE_CROSSING_M * 1000:g} mm before a post with bays, {beside};"
    if len(posts) < len(places):
        yield f"    {MARKER_BEFORE_BAY_M * 1000:g} mm before the end of a bay's tape, {beside};"
    yield "    or where the map file or its tape plan says."


def _page(shapes: tuple[Square | Line | Words, ...]) -> Page:
    return Page(PAGE_WIDTH_MM, PAGE_HEIGHT_MM, shapes)


def _cells(matrix: Iterable[Iterable[int]], left_mm: float, top_mm: float, size_mm: float) -> Iterator[Square]:
    """Cells beside each other in a row become one piece: printers leave white hairs between pieces."""
    rows = [[bool(cell) for cell in row] for row in matrix]
    cell_mm = size_mm / len(rows)
    for y, row in enumerate(rows):
        start: int | None = None
        for x, dark in enumerate([*row, False]):
            if dark and start is None:
                start = x
            elif not dark and start is not None:
                yield Square(left_mm + start * cell_mm, top_mm + y * cell_mm, (x - start) * cell_mm, cell_mm)
                start = None


def _cut_lines() -> Iterator[Line]:
    """At each corner, 5 mm inside the paper's edge."""
    for x_mm, inward in ((5.0, 1), (PAGE_WIDTH_MM - 5.0, -1)):
        for y_mm, down in ((5.0, 1), (PAGE_HEIGHT_MM - 5.0, -1)):
            yield Line(x_mm, y_mm, x_mm + inward * CUT_MM, y_mm)
            yield Line(x_mm, y_mm, x_mm, y_mm + down * CUT_MM)


# On paper


def marker_sheet(place: Post, april_tag: bool = False) -> str:
    """One page of SVG; print as many as the place has markers."""
    return as_svg(marker_page(place, april_tag=april_tag))


def places_with_sheets(campus: CampusMap, posts: Iterable[Post]) -> tuple[Post, ...]:
    """Each of the posts, followed by its bays."""
    track = campus.track
    return tuple(place for post in posts for place in (track.post(post.name), *track.bays_of(post.name)))


def all_pages(campus: CampusMap, places: tuple[Post, ...], april_tags: bool) -> tuple[Page, ...]:
    """The page that explains, then one for each marker."""
    sheets = (marker_page(place, n, april_tags) for place in places for n in range(1, len(place.markers) + 1))
    return (explaining_page(campus, places, april_tags), *sheets)
