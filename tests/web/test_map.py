"""The map as people see it, and the time that its facts are told in."""

from typing import Any

import pytest
from playwright.async_api import expect

from maps import CampusMap, builtin_map

pytestmark = pytest.mark.browser

DRAW = """async ([map, ...robots]) => {
  const drawn = Object.assign(document.createElement("campus-map"), {map, robots});
  document.querySelector("main").replaceChildren(drawn);
  await new Promise((drawn) => requestAnimationFrame(() => setTimeout(drawn, 50)));
  await drawn.updateComplete;
  const box = (element) => {
    const {x, y, width, height} = element.getBoundingClientRect();
    return [x, y, width, height];
  };
  return {
    frame: box(drawn.querySelector("svg")),
    labels: [...drawn.querySelectorAll(".label")].map((text) => [text.textContent, box(text)]),
    posts: [...drawn.querySelectorAll("circle.post")].map(box),
  };
}"""


def facts(place: object, *names: str) -> dict[str, Any]:
    return {name: getattr(place, name) for name in names}


def as_sent(campus: CampusMap) -> dict[str, Any]:
    """The map as the service sends it."""
    posts = [
        {**facts(post, "name", "title", "x_m", "y_m", "mailroom", "network"), "dock": post.dock is not None}
        for post in campus.posts.values()
    ]
    corridors = [
        {**facts(one, "name", "a", "b", "length_m", "assumed", "network"), "tape": [list(p) for p in one.tape]}
        for one in campus.corridors
    ]
    return {"name": campus.name, "title": campus.title, "note": campus.note, "posts": posts, "corridors": corridors}


def overlap(a: list[float], b: list[float]) -> bool:
    slack = 1.0
    return all(a[i] + slack < b[i] + b[i + 2] and b[i] + slack < a[i] + a[i + 2] for i in (0, 1))


@pytest.mark.parametrize(
    ("name", "seen", "next_post"), [("test_track", "post2", "post3"), ("carleton", "azrieli", "uc")]
)
@pytest.mark.parametrize("device", ["phone", "desk"])
async def test_every_post_can_be_read_and_no_label_covers_another_or_a_post(visit, name, seen, next_post, device):
    ada = await visit(on=device)
    await ada.page.goto("/")
    await expect(ada.page.get_by_role("heading", name="Send a letter")).to_be_visible()
    at = "2026-01-05T09:00:00Z"
    robot = {"name": "r1", "last_seen": {"post": seen, "at": at}, "online": True}
    robot |= {"expected": {"post": next_post, "from": at, "to": at}}
    drawn = await ada.page.evaluate(DRAW, [as_sent(builtin_map(name)), robot])
    labels = drawn["labels"]
    assert len(labels) == len(builtin_map(name).posts)
    assert sum("last seen" in text for text, _ in labels) == sum("expected" in text for text, _ in labels) == 1
    covered = [(a, b) for i, (a, at_a) in enumerate(labels) for b, at_b in labels[:i] if overlap(at_a, at_b)]
    assert covered == []
    assert [text for text, place in labels if any(overlap(place, post) for post in drawn["posts"])] == []
    left, top, width, height = drawn["frame"]
    for text, (x, y, w, h) in labels:
        assert x >= left and y >= top and x + w <= left + width and y + h <= top + height, text


CLOCK = """async (told) => {
  const {ServerClock} = await import("/server_clock.js");
  let machine_ms = 0;
  const clock = new ServerClock(() => machine_ms);
  return told.map(([at_ms, server_ms]) => {
    machine_ms = at_ms;
    if (server_ms !== null) clock.tell(server_ms);
    return clock.now();
  });
}"""


async def test_a_demonstrations_faster_time_is_drawn_on_between_two_answers(visit):
    ada = await visit()
    await ada.page.goto("/")
    told = [[0, 1_000_000], [1_000, None], [2_000, 1_020_000], [3_000, None], [4_000, 1_020_000], [9_000, None]]
    assert await ada.page.evaluate(CLOCK, told) == [1_000_000, 1_001_000, 1_020_000, 1_030_000, 1_020_000, 1_020_000]


async def test_the_map_is_drawn_while_posts_are_chosen(visit):
    ada = await visit()
    await ada.page.goto("/")
    await ada.page.get_by_label("From").select_option("Post 1")
    await ada.page.get_by_label("To", exact=True).select_option("Post 4")
    overview = ada.page.get_by_role("region", name="The paper's test track")
    await expect(overview.locator("path.way")).to_have_count(3)
    await expect(overview.get_by_role("img")).to_have_accessible_name("Map: The paper's test track")
