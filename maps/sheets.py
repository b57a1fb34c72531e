"""Marker sheets for the printer: an A5 page for each marker of each post, its codes at the size that robots expect.

A page is drawn once, as lines, squares and words in millimetres; SVG and PDF are two ways to put the same drawing on
paper.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from html import escape
from io import BytesIO

import segno

from maps.bays import MARKER_BEFORE_PLACE_M, MARKER_BESIDE_LINE_M, MARKER_SIZE_M
from maps.campus_map import CampusMap, Post
from maps.tags import TAG_SIZE_MM

PAGE_WIDTH_MM = 148
PAGE_HEIGHT_MM = 210
CODE_LEFT_MM, CODE_TOP_MM = 34, 50
TAG_LEFT_MM, TAG_TOP_MM = (PAGE_WIDTH_MM - TAG_SIZE_MM) / 2, 145.5
TAG_CELLS = 8
CUT_MM = 8.0
LENS_HEIGHT_MM = 254


@dataclass(frozen=True, slots=True)
class Square:
    """Ink, its left upper corner from that of the page."""

    left_mm: float
    top_mm: float
    width_mm: float
    height_mm: float


@dataclass(frozen=True, slots=True)
class Line:
    x0_mm: float
    y0_mm: float
    x1_mm: float
    y1_mm: float


@dataclass(frozen=True, slots=True)
class Words:
    """One line, centred at `x_mm` or begun there."""

    x_mm: float
    baseline_mm: float
    size_mm: float
    text: str
    centred: bool = True


@dataclass(frozen=True, slots=True)
class Page:
    squares: tuple[Square, ...]
    lines: tuple[Line, ...]
    words: tuple[Words, ...]


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


def marker_page(post: Post, number: int | None = None, april_tag: bool = False) -> Page:
    """The page of the post's marker `number`, or of any: all of them hold the same."""
    size_mm = MARKER_SIZE_M * 1000
    squares = tuple(_cells(marker_code(post.name).matrix, CODE_LEFT_MM, CODE_TOP_MM, size_mm))
    if april_tag and post.tag is not None:
        squares += tuple(_cells(tag_cells(post.tag), TAG_LEFT_MM, TAG_TOP_MM, TAG_SIZE_MM))
    middle = PAGE_WIDTH_MM / 2
    which = f"{len(post.markers)} of these at this post" if number is None else f"sheet {number} of {len(post.markers)}"
    ruler = Line(CODE_LEFT_MM, 191.5, CODE_LEFT_MM + size_mm, 191.5)
    words = (
        Words(middle, 24, 10, post.title),
        Words(middle, 33, 5, f"{post.name} · {which}"),
        Words(middle, 196, 3.2, f"This line is {size_mm:g} mm long when printed at 100 %."),
        Words(middle, 200.5, 3.2, f"Middle of the code {LENS_HEIGHT_MM} mm above the floor, facing the line, upright."),
    )
    return Page(squares, (*_cut_lines(), ruler), words)


def explaining_page(campus: CampusMap, posts: tuple[Post, ...], april_tags: bool) -> Page:
    """Instructions for the pages that follow, on paper."""
    sheets = sum(len(post.markers) for post in posts)
    sentences = (
        f"{sheets} sheets for {len(posts)} posts of the map {campus.name}.",
        "",
        "1. Print at 100 % (“actual size”), on white paper that does not shine.",
        f"2. Measure the line below the code: it must be {MARKER_SIZE_M * 1000:g} mm.",
        "3. Cut at the marks in the corners. Leave the white round the code.",
        f"4. Mount it upright, the middle of the code {LENS_HEIGHT_MM} mm above the floor,",
        "    facing the line, on the LEFT of a robot that arrives:",
        f"    {MARKER_BEFORE_PLACE_M * 1000:g} mm before the post, {MARKER_BESIDE_LINE_M * 1000:g} mm beside the line,",
        "    or where the map file says.",
        "5. A dock has one more, abreast of the docked robot.",
        "6. All sheets of a post are the same; each approach needs one.",
        "7. Wipe them now and then. Replace what is torn.",
        *(
            ("", "The square below the code is an AprilTag: it is read", "where the code is torn.")
            if april_tags
            else ()
        ),
    )
    head = Words(PAGE_WIDTH_MM / 2, 24, 8, campus.title)
    rows = (Words(14, 38 + 6.5 * row, 3.6, text, centred=False) for row, text in enumerate(sentences) if text)
    counts = [f"{post.name}: {len(post.markers)}" for post in posts]
    last_mm = 38 + 6.5 * (len(sentences) + 1)
    table = (Words(14 + 40 * (n % 3), last_mm + 5 * (n // 3), 3.2, text, False) for n, text in enumerate(counts))
    return Page((), (), (head, *rows, *table))


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


def as_svg(page: Page) -> str:
    """148 × 210 mm; to be printed at 100 %."""
    squares = "".join(
        f"M{ink.left_mm:.4f} {ink.top_mm:.4f}h{ink.width_mm:.4f}v{ink.height_mm:.4f}h{-ink.width_mm:.4f}z"
        for ink in page.squares
    )
    strokes = "".join(f"M{line.x0_mm:g} {line.y0_mm:g}L{line.x1_mm:g} {line.y1_mm:g}" for line in page.lines)
    words = "\n".join(_svg_words(words) for words in page.words)
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="{PAGE_WIDTH_MM}mm" height="{PAGE_HEIGHT_MM}mm" \
viewBox="0 0 {PAGE_WIDTH_MM} {PAGE_HEIGHT_MM}" font-family="sans-serif">
<rect width="{PAGE_WIDTH_MM}" height="{PAGE_HEIGHT_MM}" fill="#fff"/>
<path d="{squares}" shape-rendering="crispEdges"/>
<path d="{strokes}" stroke="#000" stroke-width=".3"/>
{words}
</svg>
"""


def _svg_words(words: Words) -> str:
    anchor = ' text-anchor="middle"' if words.centred else ""
    place = f'x="{words.x_mm:g}" y="{words.baseline_mm:g}" font-size="{words.size_mm:g}"{anchor}'
    return f"<text {place}>{escape(words.text)}</text>"


def as_pdf(pages: tuple[Page, ...], title: str) -> bytes:
    """Return all pages in one file. The same pages give the same bytes."""
    from reportlab.lib.units import mm
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    # A font that comes with the library and knows more letters than the printer's own ones.
    pdfmetrics.registerFont(TTFont("Vera", "Vera.ttf"))
    file = BytesIO()
    canvas = Canvas(file, (PAGE_WIDTH_MM * mm, PAGE_HEIGHT_MM * mm), invariant=True)
    canvas.setTitle(title)
    # The printing program must not shrink it to its own margins.
    canvas.setViewerPreference("PrintScaling", "None")
    for page in pages:
        for square in page.squares:
            bottom_mm = PAGE_HEIGHT_MM - square.top_mm - square.height_mm
            canvas.rect(square.left_mm * mm, bottom_mm * mm, square.width_mm * mm, square.height_mm * mm, 0, 1)
        canvas.setLineWidth(0.3 * mm)
        for line in page.lines:
            ends = (line.x0_mm, PAGE_HEIGHT_MM - line.y0_mm, line.x1_mm, PAGE_HEIGHT_MM - line.y1_mm)
            canvas.line(*(end * mm for end in ends))
        for words in page.words:
            canvas.setFont("Vera", words.size_mm * mm)
            write = canvas.drawCentredString if words.centred else canvas.drawString
            write(words.x_mm * mm, (PAGE_HEIGHT_MM - words.baseline_mm) * mm, words.text)
        canvas.showPage()
    canvas.save()
    return file.getvalue()


def marker_sheet(post: Post, april_tag: bool = False) -> str:
    """One page of SVG; print as many as the post has markers."""
    return as_svg(marker_page(post, april_tag=april_tag))


def all_pages(campus: CampusMap, posts: tuple[Post, ...], april_tags: bool) -> tuple[Page, ...]:
    """The page that explains, then one for each marker."""
    sheets = (marker_page(post, n, april_tags) for post in posts for n in range(1, len(post.markers) + 1))
    return (explaining_page(campus, posts, april_tags), *sheets)
