"""The letters of an Android phone, wherever the pictures are taken: each machine has other ones, or wider ones."""

from pathlib import Path
from typing import Final

from fontTools.ttLib import TTFont

from tests.web.service import ROOT

FILES: Final = ROOT / "web/node_modules/@fontsource/roboto/files"
WEIGHTS: Final = (400, 500, 600, 700)
FONTCONFIG: Final = """<?xml version="1.0"?><!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig><include ignore_missing="yes">/etc/fonts/fonts.conf</include><dir>{0}</dir><cachedir>{0}/cache</cachedir>
</fontconfig>"""


def environment(folder: Path) -> dict[str, str]:
    """Configuration by which a browser finds Roboto in `folder`. It reads no WOFF from there, so they are unpacked."""
    for weight in WEIGHTS:
        font = TTFont(FILES / f"roboto-latin-{weight}-normal.woff")
        font.flavor = None
        font.save(folder / f"roboto-{weight}.ttf")
    config = folder / "fonts.conf"
    config.write_text(FONTCONFIG.format(folder))
    return {"FONTCONFIG_FILE": str(config)}
