"""Checks that a picture on a page is really drawn."""

from playwright.async_api import Locator, expect


async def expect_drawn(image: Locator) -> None:
    """It has come, and it is a picture: one that cannot be read is complete, too, and has no width."""
    await expect(image).to_have_js_property("complete", True)
    assert await image.evaluate("(image) => image.naturalWidth") > 0
