"""`make icons` draws the app's icons for home screens and notices from our own SVG, with the browser of the tests."""

from pathlib import Path
from typing import Final

from playwright.sync_api import sync_playwright

ICONS: Final = Path(__file__).parent / "public/icons"
SIZES: Final = {"icon": (192, 512), "icon-maskable": (192, 512), "badge": (96,)}


def main() -> None:
    """Write one PNG for each size."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium")
        page = browser.new_page()
        for name, sizes in SIZES.items():
            picture = (ICONS / f"{name}.svg").read_text(encoding="utf-8")
            for size in sizes:
                page.set_viewport_size({"width": size, "height": size})
                page.set_content(f"<style>* {{ margin: 0 }} svg {{ display: block; width: {size}px }}</style>{picture}")
                page.screenshot(path=ICONS / f"{name}-{size}.png", omit_background=True)
        browser.close()


if __name__ == "__main__":
    main()
