"""Drawings in millimetres from the left upper corner of a page, and two ways to put them on paper: SVG and PDF."""

from collections.abc import Iterable
from dataclasses import dataclass
from html import escape
from io import BytesIO
from itertools import groupby
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from reportlab.pdfgen.canvas import Canvas

Align = Literal["left", "centre", "right"]
BLACK, WHITE = "#000000", "#ffffff"
THIN_MM = 0.3


@dataclass(frozen=True, slots=True)
class Square:
    """Ink."""

    left_mm: float
    top_mm: float
    width_mm: float
    height_mm: float
    colour: str = BLACK


@dataclass(frozen=True, slots=True)
class Line:
    x0_mm: float
    y0_mm: float
    x1_mm: float
    y1_mm: float
    width_mm: float = THIN_MM
    colour: str = BLACK
    dashed: bool = False


@dataclass(frozen=True, slots=True)
class Circle:
    x_mm: float
    y_mm: float
    radius_mm: float
    width_mm: float = THIN_MM
    colour: str = BLACK
    dashed: bool = False
    fill: str | None = None


@dataclass(frozen=True, slots=True)
class Words:
    """One line that begins, ends or has its middle at `x_mm`; `on_white`: nothing shows through between the letters."""

    x_mm: float
    baseline_mm: float
    size_mm: float
    text: str
    align: Align = "centre"
    bold: bool = False
    colour: str = BLACK
    on_white: bool = False


Shape = Square | Line | Circle | Words


@dataclass(frozen=True, slots=True)
class Page:
    """Later shapes lie above earlier ones."""

    width_mm: float
    height_mm: float
    shapes: tuple[Shape, ...]


# SVG

ANCHORS = {"left": "start", "centre": "middle", "right": "end"}


def as_svg(page: Page) -> str:
    """The page at its size; to be printed at 100 %."""
    shapes = "\n".join(_svg_of(list(alike)) for _, alike in groupby(page.shapes, key=_is_square_of))
    size = f'width="{page.width_mm:g}mm" height="{page.height_mm:g}mm"'
    return f"""<svg xmlns="http://www.w3.org/2000/svg" {size} \
viewBox="0 0 {page.width_mm:g} {page.height_mm:g}" font-family="sans-serif">
<rect width="{page.width_mm:g}" height="{page.height_mm:g}" fill="{WHITE}"/>
{shapes}
</svg>
"""


def _is_square_of(shape: Shape) -> str:
    return shape.colour if isinstance(shape, Square) else ""


def _svg_of(alike: list[Shape]) -> str:
    """Squares of a colour in one piece, everything else by itself."""
    squares = [shape for shape in alike if isinstance(shape, Square)]
    if not squares:
        return "\n".join(_svg_shape(shape) for shape in alike)
    path = "".join(
        f"M{ink.left_mm:.4f} {ink.top_mm:.4f}h{ink.width_mm:.4f}v{ink.height_mm:.4f}h{-ink.width_mm:.4f}z"
        for ink in squares
    )
    return f'<path d="{path}" fill="{squares[0].colour}" shape-rendering="crispEdges"/>'


def _svg_shape(shape: Shape) -> str:
    match shape:
        case Line():
            path = f"M{shape.x0_mm:g} {shape.y0_mm:g}L{shape.x1_mm:g} {shape.y1_mm:g}"
            return f'<path d="{path}" {_svg_stroke(shape)}/>'
        case Circle():
            place = f'cx="{shape.x_mm:g}" cy="{shape.y_mm:g}" r="{shape.radius_mm:g}"'
            return f'<circle {place} fill="{shape.fill or "none"}" {_svg_stroke(shape)}/>'
        case Words():
            place = f'x="{shape.x_mm:g}" y="{shape.baseline_mm:g}" font-size="{shape.size_mm:g}"'
            look = f'text-anchor="{ANCHORS[shape.align]}" fill="{shape.colour}"'
            look += ' font-weight="bold"' if shape.bold else ""
            look += f' stroke="{WHITE}" stroke-width="1" paint-order="stroke"' if shape.on_white else ""
            return f"<text {place} {look}>{escape(shape.text)}</text>"
        case Square():
            return _svg_of([shape])


def _svg_stroke(shape: Line | Circle) -> str:
    dashes = ' stroke-dasharray="1.5 1"' if shape.dashed else ""
    return f'stroke="{shape.colour}" stroke-width="{shape.width_mm:g}"{dashes}'


# PDF


def as_pdf(pages: Iterable[Page], title: str) -> bytes:
    """Return all pages in one file. The same pages give the same bytes."""
    from reportlab.lib.units import mm
    from reportlab.pdfbase import pdfmetrics
    from reportlab.pdfbase.ttfonts import TTFont
    from reportlab.pdfgen.canvas import Canvas

    # Fonts that come with the library and know more letters than the printer's own ones.
    pdfmetrics.registerFont(TTFont("Vera", "Vera.ttf"))
    pdfmetrics.registerFont(TTFont("VeraBd", "VeraBd.ttf"))
    file = BytesIO()
    canvas = Canvas(file, invariant=True)
    canvas.setTitle(title)
    # The printing program must not shrink it to its own margins.
    canvas.setViewerPreference("PrintScaling", "None")
    for page in pages:
        canvas.setPageSize((page.width_mm * mm, page.height_mm * mm))
        # Millimetres from the left upper corner, as everything here; text is turned back below.
        canvas.transform(mm, 0, 0, -mm, 0, page.height_mm * mm)
        for shape in page.shapes:
            _draw(canvas, shape)
        canvas.showPage()
    canvas.save()
    return file.getvalue()


def _draw(canvas: "Canvas", shape: Shape) -> None:
    match shape:
        case Square():
            canvas.setFillColor(shape.colour)
            canvas.rect(shape.left_mm, shape.top_mm, shape.width_mm, shape.height_mm, 0, 1)
        case Line():
            _set_stroke(canvas, shape)
            canvas.line(shape.x0_mm, shape.y0_mm, shape.x1_mm, shape.y1_mm)
        case Circle():
            _set_stroke(canvas, shape)
            canvas.setFillColor(shape.fill or WHITE)
            canvas.circle(shape.x_mm, shape.y_mm, shape.radius_mm, 1, int(shape.fill is not None))
        case Words():
            _write(canvas, shape)


def _set_stroke(canvas: "Canvas", shape: Line | Circle) -> None:
    canvas.setLineWidth(shape.width_mm)
    canvas.setStrokeColor(shape.colour)
    canvas.setDash([1.5, 1.0] if shape.dashed else [])


def _write(canvas: "Canvas", words: Words) -> None:
    font = "VeraBd" if words.bold else "Vera"
    width_mm = canvas.stringWidth(words.text, font, words.size_mm)
    left_mm = words.x_mm - {"left": 0.0, "centre": width_mm / 2, "right": width_mm}[words.align]
    if words.on_white:
        canvas.setFillColor(WHITE)
        canvas.rect(left_mm - 0.5, words.baseline_mm - words.size_mm * 0.85, width_mm + 1, words.size_mm * 1.15, 0, 1)
    canvas.saveState()
    canvas.transform(1, 0, 0, -1, left_mm, words.baseline_mm)
    canvas.setFillColor(words.colour)
    canvas.setFont(font, words.size_mm)
    canvas.drawString(0, 0, words.text)
    canvas.restoreState()
