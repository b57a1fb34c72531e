"""Names on the map lie on no line, as the browser has drawn them, on all maps that are shipped."""

from typing import Any

import pytest
from playwright.async_api import Route, expect

from maps import builtin_map
from tests.web.looking import DESK, NARROW, PHONE
from tests.web.test_map import as_sent

pytestmark = pytest.mark.browser

SIZES = {"320 px": NARROW, "phone": PHONE, "desk": DESK}
# On the smallest phone the corridors around Azrieli are close: a name with two lines of notes has no place of its own
# there, and is said on a line. Names without notes are left out before that, so many at most.
NO_ROOM = {
    ("carleton", "320 px"): {
        *("azrieli library", "library azrieli", "azrieli junction", "junction azrieli", "azrieli uc", "uc azrieli"),
        *("library junction", "loeb southam"),
    }
}
LEFT_OUT = {("carleton", "320 px"): 2}

ON_LINES = """async ([map, scenes]) => {
  await import("/src/map/campus_map.js");
  const drawn = Object.assign(document.createElement("campus-map"), {map});
  document.querySelector("main").replaceChildren(drawn);
  const frames = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  await frames();
  const at = (minute) => `2026-01-05T15:${minute}:00Z`;
  const touched = ({left, right, top, bottom}, points, half) =>
    points.some(({x, y}) => x > left - half && x < right + half && y > top - half && y < bottom + half);
  const look = () => {
    const svg = drawn.querySelector("svg");
    const half = svg.getScreenCTM().a * parseFloat(getComputedStyle(svg.querySelector(".corridor")).strokeWidth) / 2;
    const points = [...svg.querySelectorAll("path.corridor")].flatMap((path) => {
      const [toScreen, length] = [path.getScreenCTM(), path.getTotalLength()];
      const steps = [...Array(Math.ceil(length) + 1).keys()].map((step) => Math.min(step, length));
      return steps.map((step) => path.getPointAtLength(step).matrixTransform(toScreen));
    });
    const words = [...svg.querySelectorAll(".label tspan")];
    const on_lines = words.filter((line) => touched(line.getBoundingClientRect(), points, half));
    const names = svg.querySelectorAll(".label").length;
    return {names, words: words.map((line) => line.textContent), on_lines: on_lines.map((line) => line.textContent)};
  };
  const found = {none: look()};
  for (const [post, next] of scenes) {
    drawn.robots = [{
      name: "r1", last_seen: {post, at: at(27)}, expected: {post: next, from: at(41), to: at(44)}, towards: next,
      heard_at: at(25), online: true, activity: "driving", battery: {ratio: 0.5, charging: false}, why_words: null,
    }];
    await drawn.updateComplete;
    await frames();
    found[`${post} ${next}`] = look();
  }
  return found;
}"""


async def tell_the_time(route: Route) -> None:
    """Four digits on each side: the longest there are to be said."""
    answer = await route.fetch()
    await route.fulfill(json=await answer.json() | {"now": "2026-01-05T15:30:00Z"})


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", ["test_track", "carleton"])
@pytest.mark.nightly
async def test_no_name_lies_on_a_corridor_without_robots_and_with_one_on_any_of_them(visit, name, size):
    campus = builtin_map(name)
    ways = [way for one in campus.corridors for way in ((one.a, one.b), (one.b, one.a))]
    ada = await visit(viewport=SIZES[size], timezone_id="America/Toronto", signed_in=False)
    await ada.page.route("**/api/v1/about", tell_the_time)
    await ada.page.goto("/")
    await expect(ada.page.get_by_label("Email address")).to_be_visible()
    found: dict[str, Any] = await ada.page.evaluate(ON_LINES, [as_sent(campus), ways])
    plain, said = found.pop("none"), " ".join(text for one in found.values() for text in one["words"])
    assert plain["on_lines"] == []
    assert plain["names"] >= len(campus.posts) - LEFT_OUT.get((name, size), 0)
    assert "10:41–10:44" in said
    assert len(found) == len(ways)
    assert {way for way, one in found.items() if one["on_lines"]} <= NO_ROOM.get((name, size), set())
