"""Marker sheets for the printer: one page for each post, its QR code at the exact size the robot expects."""

from html import escape

import segno

from maps.campus_map import MARKER_SIZE_M, Post

PAGE_WIDTH_MM = 148
PAGE_HEIGHT_MM = 210


def marker_code(post: str) -> segno.QRCode:
    """The QR code that says the post's name: error correction H, so that it can lose 30 % to dirt."""
    return segno.make(post, error="h", micro=False, boost_error=False)


def marker_sheet(post: Post) -> str:
    """One page of SVG, 148 × 210 mm; print it at 100 %, the code itself is then 80 mm wide."""
    code = marker_code(post.name)
    size_mm = MARKER_SIZE_M * 1000
    middle_mm, left_mm, top_mm = PAGE_WIDTH_MM / 2, (PAGE_WIDTH_MM - size_mm) / 2, 50
    scale = size_mm / len(code.matrix)
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="{PAGE_WIDTH_MM}mm" height="{PAGE_HEIGHT_MM}mm" \
viewBox="0 0 {PAGE_WIDTH_MM} {PAGE_HEIGHT_MM}" font-family="sans-serif" text-anchor="middle">
<rect width="{PAGE_WIDTH_MM}" height="{PAGE_HEIGHT_MM}" fill="#fff"/>
<text x="{middle_mm}" y="28" font-size="10">{escape(post.title)}</text>
<g transform="translate({left_mm} {top_mm}) scale({scale:.6f})">{_modules(code)}</g>
<path d="M{left_mm} 146h{size_mm}" stroke="#000" stroke-width=".3"/>
<text x="{middle_mm}" y="152" font-size="4">This line is {size_mm:g} mm long when printed at 100 %.</text>
<text x="{middle_mm}" y="160" font-size="4">Middle of the code 254 mm above the floor, left of the line.</text>
<text x="{middle_mm}" y="168" font-size="4">{escape(post.name)} · {len(post.markers)} of these at this post</text>
</svg>
"""


def _modules(code: segno.QRCode) -> str:
    squares = (f"M{x} {y}h1v1h-1z" for y, row in enumerate(code.matrix) for x, dark in enumerate(row) if dark)
    return f'<path d="{"".join(squares)}" shape-rendering="crispEdges"/>'
