"""The tape plan: an overview of the campus with the length of each corridor, and a page for each post with bays."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from maps.campus_map import CampusMap, Corridor, Post
from maps.drawing import Align, Circle, Page, Shape, Words
from maps.geometry import path_length_m, point_along, wrapped
from maps.plan_paper import (
    GREY,
    HEIGHT_MM,
    INNER_MM,
    MARGIN_MM,
    ROW_MM,
    TEXT_MM,
    Box,
    Column,
    View,
    fitting_view,
    frame,
    north_and_scale,
    paper,
    table,
)
from maps.tape_post import post_page

TOP_MM: Final = 33.0
LEAST_HEIGHT_MM: Final = 150.0
"""Of the drawing of the campus, however many corridors there are."""
LONG_SPUR_MM: Final = 3.0
"""A shorter one is hidden by the dot of its post."""
COLUMNS: Final = (Column("corridor", 50), Column("length", 20, "right"), Column("", 18))
TABLES_A_PAGE: Final = 2
UNDER_MM, FOOT_MM = 9.0, HEIGHT_MM - 16
"""Between drawing and table; where the table has to end."""
DIRECTIONS: Final = 16


def tape_pages(campus: CampusMap) -> tuple[Page, ...]:
    """Every page, numbered."""
    posts = [post for post in campus.posts.values() if post.spurs]
    first, more = _rows_that_fit(TOP_MM + LEAST_HEIGHT_MM + UNDER_MM), _rows_that_fit(TOP_MM)
    rest = campus.corridors[first:]
    chunks = [campus.corridors[:first], *(rest[at : at + more] for at in range(0, len(rest), more))]
    count = len(chunks) + len(posts)
    overview = [_overview(campus, chunks[0], count)]
    overview += [_more_corridors(campus, chunk, number, count) for number, chunk in enumerate(chunks[1:], start=2)]
    return (*overview, *(post_page(campus, post, len(chunks) + n, count) for n, post in enumerate(posts, start=1)))


def _rows_that_fit(top_mm: float) -> int:
    return TABLES_A_PAGE * int((FOOT_MM - top_mm) / ROW_MM - 1)


def _overview(campus: CampusMap, corridors: Sequence[Corridor], count: int) -> Page:
    posts, bays = len(campus.posts), [bay for post in campus.posts.values() for bay in post.spurs]
    under = f"Tape plan · posts: {posts} · corridors: {len(campus.corridors)} · bays: {len(bays)}"
    rows = -(-len(corridors) // TABLES_A_PAGE) + 1
    box = Box(MARGIN_MM, TOP_MM, INNER_MM, FOOT_MM - TOP_MM - UNDER_MM - rows * ROW_MM)
    points = [*(post.point for post in campus.posts.values()), *(bay.point for bay in bays)]
    points += [dot for corridor in campus.corridors for dot in corridor.tape]
    view = fitting_view(points, box, padding_mm=14)
    shapes = [*frame(box), *_campus(view, campus), *north_and_scale(view)]
    top_mm = box.top_mm + box.height_mm
    said = "~ and a dashed line: the length is assumed. Measure it before robots drive."
    if any(corridor.assumed for corridor in campus.corridors):
        shapes.append(Words(MARGIN_MM, top_mm + 6, TEXT_MM, said, "left", colour=GREY))
    shapes += _tables(top_mm + UNDER_MM, corridors)
    return paper(campus, campus.title, under, 1, count, shapes)


def _more_corridors(campus: CampusMap, corridors: Sequence[Corridor], number: int, count: int) -> Page:
    return paper(campus, campus.title, "Tape plan · more corridors", number, count, _tables(TOP_MM, corridors))


def _tables(top_mm: float, corridors: Sequence[Corridor]) -> Iterator[Shape]:
    half = -(-len(corridors) // TABLES_A_PAGE)
    for column in range(TABLES_A_PAGE):
        rows = [_row(corridor) for corridor in corridors[column * half : (column + 1) * half]]
        if rows:
            yield from table(top_mm, COLUMNS, rows, MARGIN_MM + column * (INNER_MM + 4) / TABLES_A_PAGE)


def _row(corridor: Corridor) -> Sequence[str]:
    return f"{corridor.a} – {corridor.b}", f"{corridor.length_m:.2f} m", "assumed" if corridor.assumed else ""


# The drawing


def _campus(view: View, campus: CampusMap) -> Iterator[Shape]:
    for corridor in campus.corridors:
        yield from view.path(corridor.tape, 0.7, dashed=corridor.assumed)
    for post in campus.posts.values():
        for bay in post.spurs:
            yield from view.path((post.point, bay.point), 0.7)
    for corridor in campus.corridors:
        x_mm, y_mm = view.place(point_along(corridor.tape, path_length_m(corridor.tape) / 2))
        length = f"{'~' if corridor.assumed else ''}{corridor.length_m:.4g} m"
        yield Words(x_mm, y_mm + 0.9, 2.5, length, colour=GREY, on_white=True)
    for post in campus.posts.values():
        yield Circle(*view.place(post.point), 1.3, fill="#000000")
        yield _name(view, campus, post)


def _name(view: View, campus: CampusMap, post: Post) -> Words:
    """Beside the post, on the side that is farthest from all lines."""
    lines = [corridor for _, corridor in campus.track.neighbours(post.name)]
    taken = [line.heading_leaving(post.name) for line in lines if view.size_mm(line.length_m) > LONG_SPUR_MM]
    angles = [math.tau * step / DIRECTIONS for step in range(DIRECTIONS)]
    angle = max(angles, key=lambda one: round(min((abs(wrapped(one - line)) for line in taken), default=0.0), 3))
    x_mm, y_mm = view.place(post.point)
    across = math.cos(angle)
    align: Align = "left" if across > 0.3 else "right" if across < -0.3 else "centre"
    y_mm += 1.1 - 3.4 * math.sin(angle)
    return Words(x_mm + 3 * across, y_mm, 3, post.name, align, bold=True, on_white=True)
