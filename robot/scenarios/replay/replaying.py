"""A recording as one self-contained page: a map, a time axis, a player; no library, no network."""

import json
import re
from base64 import b64encode
from hashlib import sha256
from html import escape
from pathlib import Path
from typing import Final

from robot.scenarios.errors import RecordingError
from robot.scenarios.replay.recording import Row, read_recording

FOLDER: Final = Path(__file__).parent / "page"
SCRIPTS: Final = ("data.js", "map.js", "axis.js", "player.js")


def page(rows: list[Row]) -> str:
    """The page's HTML. Its policy allows exactly this script and this style, and nothing from elsewhere."""
    style, script = _text("replay.css"), "".join(map(_text, SCRIPTS))
    policy = f"default-src 'none'; script-src '{_hash(script)}'; style-src '{_hash(style)}'"
    title = str(rows[0].get("title") or "A run")
    parts = {
        "{{POLICY}}": policy,
        "{{TITLE}}": escape(title),
        "{{STYLE}}": style,
        "{{SCRIPT}}": script,
        "{{DATA}}": _inert(rows),
    }
    # In one pass: what is put in is never searched for places itself.
    return re.sub(r"\{\{[A-Z]+\}\}", lambda place: parts[place.group()], _text("replay.html"))


def write_page(recording: Path, target: Path) -> None:
    """Raises RecordingError."""
    html = page(read_recording(recording))
    try:
        target.write_text(html, "utf-8")
    except OSError as error:
        raise RecordingError(f"{target}: cannot be written: {error.strerror}. Give another page.") from None


def _text(name: str) -> str:
    return (FOLDER / name).read_text("utf-8")


def _hash(text: str) -> str:
    return "sha256-" + b64encode(sha256(text.encode()).digest()).decode()


def _inert(rows: list[Row]) -> str:
    """JSON that cannot end its script element or begin a comment in it."""
    text = json.dumps(rows, separators=(",", ":"), ensure_ascii=True)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")
