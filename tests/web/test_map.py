"""The map as people see it, and the time that its facts are told in."""

import re
from typing import Any

import pytest
from playwright.async_api import Locator, Page, expect

from maps import CampusMap, Post, builtin_map

pytestmark = pytest.mark.browser

DRAW = """async ([map, ...robots]) => {
  await import("/src/map/campus_map.js");
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
    posts: [...drawn.querySelectorAll("circle.post, [data-bay]")].map(box),
  };
}"""


def facts(place: object, *names: str) -> dict[str, Any]:
    return {name: getattr(place, name) for name in names}


def bays(post: Post) -> list[dict[str, Any]]:
    return [
        {**facts(bay, "name", "x_m", "y_m", "home"), "dock": bay.dock is not None, "markers": 1} for bay in post.spurs
    ]


def as_sent(campus: CampusMap) -> dict[str, Any]:
    """The map as the service sends it."""
    posts = [
        {
            **facts(post, "name", "title", "x_m", "y_m", "mailroom", "network"),
            "dock": post.dock is not None,
            "bays": bays(post),
        }
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
    soon = "2100-01-05T09:00:00Z"  # what is over is no longer expected
    robot |= {"expected": {"post": next_post, "from": soon, "to": soon}}
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
  const {ServerClock} = await import("/src/service/server_clock.js");
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


VIEWS = """async () => {
  const view = await import("/src/map/map_view.js");
  const frame = {x: -50, y: 0, width: 400, height: 200};
  const whole = view.whole(frame);
  const corner = {x: 340, y: 10};
  const near = view.zoomed(whole, frame, 4, corner);
  const onScreen = ({x, y, zoom}) => [(corner.x - x) * zoom, (corner.y - y) * zoom];
  const robots = [{x: 0, y: 100}, {x: 100, y: 100}];
  return {
    whole, corner: [onScreen(whole), onScreen(near)],
    far: view.zoomed(near, frame, 0.01), closest: view.zoomed(near, frame, 100).zoom,
    beyond: view.moved(near, frame, 1000, -1000), atWhole: view.moved(whole, frame, 50, 50),
    one: view.showing([robots[0]], frame), two: view.showing(robots, frame), none: view.showing([], frame),
    halfway: view.onTheWay(whole, near, 0.5).zoom, there: view.onTheWay(whole, near, 1) === near,
    letters: [[1, 1], [1, 3], [0.7, 1], [0.7, 3], [0.5, 1], [2, 1]].map(([px, zoom]) => px * view.sizeOf(px, zoom)),
    seen: view.windowOf(near, frame, 2),
  };
}"""


@pytest.mark.slow
async def test_the_arithmetic_of_views(visit):
    ada = await visit()
    await ada.page.goto("/")
    found = await ada.page.evaluate(VIEWS)
    assert found["whole"] == found["far"] == found["atWhole"] == found["none"] == {"x": 150, "y": 100, "zoom": 1}
    assert found["corner"][0] == pytest.approx(found["corner"][1]), "what is pointed at stays where it is"
    assert (found["closest"], found["there"]) == (6, True)
    assert found["beyond"] == {"x": 300, "y": 25, "zoom": 4}, "nothing beyond the frame is looked at"
    assert found["one"]["zoom"] > 1 and found["one"]["zoom"] >= found["two"]["zoom"]
    assert found["halfway"] == pytest.approx(2)
    assert found["seen"]["width"] == 200, "twice the letters, half of them"
    plain, near, small, small_near, tiny, large = found["letters"]
    assert plain == near == small_near == pytest.approx(1), "letters do not grow beyond their size"
    assert small == tiny == pytest.approx(10 / 13), "and can be read on any screen"
    assert large == 2


async def drawn(page: Page, *scene: Any) -> Locator:
    """A map alone on the page."""
    await page.evaluate(SCENE, list(scene))
    return page.get_by_role("group", name="Map. Arrow keys")


SCENE = """async ([map, robots, traffic]) => {
  await import("/src/map/campus_map.js");
  const at = (s) => new Date(Date.now() + 1000 * s).toISOString();
  const known = robots.map(({seen, to, ...robot}) => ({
    last_seen: {post: seen, at: at(-130)}, expected: to ? {post: to, from: at(60), to: at(240)} : null, towards: to,
    heard_at: at(-400), online: true, activity: "driving", battery: {ratio: 0.5, charging: false}, why_words: null,
    ...robot,
  }));
  const drawn = Object.assign(document.createElement("campus-map"), {map, robots: known, facts: true});
  drawn.traffic = traffic.map(([robot, from_post, to_post]) => (
    {robot, from_post, to_post, corridor: [from_post, to_post].sort().join("-"), since: at(-100)}));
  const titles = ["h1", "h2"].map((level) => Object.assign(document.createElement(level), {textContent: "Robots"}));
  document.querySelector("main").replaceChildren(...titles, drawn);
  await new Promise((drawn) => requestAnimationFrame(() => setTimeout(drawn, 50)));
  await drawn.updateComplete;
}"""
ONE = [{"name": "r1", "seen": "post2", "to": "post3", "why": "Driving towards post3"}]
BOX = "(svg) => svg.getAttribute('viewBox').split(' ').map(Number)"
LETTERS = "(svg) => svg.querySelector('.label').getBoundingClientRect().height"


async def test_the_map_is_brought_closer_and_moved_by_buttons_wheel_and_keys(visit):
    ada = await visit(reduced_motion="reduce")
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    area = await drawn(page, as_sent(builtin_map("test_track")), ONE, [])
    svg = area.get_by_role("img", name="Map: The paper's test track")
    whole, letters = await svg.evaluate(BOX), await svg.evaluate(LETTERS)
    await expect(page.get_by_role("button", name="Zoom out")).to_have_attribute("aria-disabled", "true")
    await page.get_by_role("button", name="Zoom in").click()
    closer = await svg.evaluate(BOX)
    assert closer[:2] != whole[:2] and closer[2:] == whole[2:], "at once, for users who prefer less motion"
    assert await svg.evaluate(LETTERS) == pytest.approx(letters, abs=2), "letters stay as large as they are"

    await page.get_by_role("button", name="Go to robot").click()
    robot, frame = await svg.locator(".robot").bounding_box(), await svg.bounding_box()
    assert robot and frame and frame["x"] < robot["x"] < frame["x"] + frame["width"]
    for note in ("last seen", "expected"):
        label = await svg.locator(".label", has_text=note).bounding_box()
        assert label and frame["x"] <= label["x"] and label["x"] + label["width"] <= frame["x"] + frame["width"]
    await area.focus()
    for key, axis, sign in [("ArrowRight", 0, 1), ("ArrowDown", 1, 1), ("ArrowLeft", 0, -1)]:
        before = await svg.evaluate(BOX)
        await page.keyboard.press(key)
        assert (await svg.evaluate(BOX))[axis] * sign > before[axis] * sign, key
    await page.keyboard.press("0")
    assert await svg.evaluate(BOX) == whole
    await page.keyboard.press("+")
    assert await svg.evaluate(BOX) == closer
    await page.keyboard.press("-")
    assert await svg.evaluate(BOX) == whole

    await page.mouse.move(frame["x"] + frame["width"] / 2, frame["y"] + 40)
    await page.mouse.wheel(0, -200)
    assert await svg.evaluate(BOX) == whole, "the wheel alone is for the page"
    await page.keyboard.down("Control")
    await page.mouse.wheel(0, -200)
    await page.keyboard.up("Control")
    await expect(page.get_by_role("button", name="Zoom out")).not_to_have_attribute("aria-disabled", "true")
    before = await svg.evaluate(BOX)
    await page.mouse.down()
    await page.mouse.move(frame["x"] + frame["width"] / 2 - 60, frame["y"] + 60)
    await page.mouse.up()
    after = await svg.evaluate(BOX)
    assert after[0] > before[0] and after[1] < before[1], "dragged with the mouse"
    await ada.assert_accessible()


async def touch(page: Page, *steps: list[tuple[float, float]]) -> None:
    """Fingers put down at the first places, moved to the next ones, taken up."""
    browser = await page.context.new_cdp_session(page)
    for kind, places in zip(["touchStart", *["touchMove"] * (len(steps) - 1)], steps, strict=True):
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
        await browser.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    await browser.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})


async def test_two_fingers_bring_it_closer_and_one_moves_it_only_then(visit):
    ada = await visit(on="phone")
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    area = await drawn(page, as_sent(builtin_map("carleton")), [{**ONE[0], "seen": "uc", "to": "canal"}], [])
    svg = area.get_by_role("img")
    whole, letters, named = await svg.evaluate(BOX), await svg.evaluate(LETTERS), await svg.locator(".label").count()
    assert await svg.evaluate("(svg) => getComputedStyle(svg).touchAction") == "pan-x pan-y", "one finger scrolls"
    frame = await svg.bounding_box()
    assert frame
    x, y = frame["x"] + frame["width"] / 2, frame["y"] + frame["height"] / 2
    await touch(page, [(x - 30, y), (x + 30, y)], [(x - 60, y), (x + 60, y)], [(x - 90, y), (x + 90, y)])
    assert await svg.evaluate("(svg) => getComputedStyle(svg).touchAction") == "none"
    near = await svg.evaluate(BOX)
    assert near[:2] != whole[:2]
    assert await svg.evaluate(LETTERS) > letters, "on a small screen they grow until they have their size"
    assert await svg.locator(".label").count() >= named
    await touch(page, [(x, y)], [(x - 20, y - 20)], [(x - 60, y - 60)])
    moved = await svg.evaluate(BOX)
    assert moved[0] > near[0] and moved[1] > near[1]
    await page.get_by_role("button", name="Whole map").click()
    await expect(page.get_by_role("button", name="Whole map")).to_have_attribute("aria-disabled", "true")
    await expect(svg).not_to_have_class(re.compile("closer"))


FOUR = [
    {"name": "r1", "seen": "post3", "to": "post4", "online": False, "why": "Driving towards post4"},
    {"name": "r2", "seen": "post3", "activity": "stopped", "why": "A person stopped the robot."},
    {
        "name": "r3",
        "seen": "post5",
        "activity": "charging",
        "battery": {"ratio": 0.3, "charging": True, "charges_to": {"ratio": 0.8, "at": "2126-01-05T09:03:25Z"}},
        "why": "Charging",
    },
    {"name": "r4", "seen": "post5", "to": "post3", "why": "Driving towards post3"},
]
TAKEN = [["r1", "post3", "post4"], ["r4", "post5", "post3"], ["r9", "post1", "post2"]]
TOLD = """(map) => {
  const all = (selector) => [...map.querySelectorAll(selector)];
  const box = (element) => {
    const {x, y, width, height} = element.getBoundingClientRect();
    return [x, y, width, height];
  };
  return {
    seen: all(".robot").map(({dataset, classList}) => [dataset.robot, dataset.post, [...classList].slice(1).join(" ")]),
    expected: all(".expected[data-post]").map(({dataset}) => [dataset.robots, dataset.post]),
    taken: all(".taken[data-robot]").map(({dataset}) => [dataset.robot, dataset.corridor]),
    silent: all(".silent").map(({dataset}) => dataset.corridor ?? dataset.post),
    robots: all(".robot .body").map(box),
    labels: all(".label").map((text) => [text.textContent, box(text)]),
    lists: all(".facts.several > li").filter((li) => li.querySelector("strong")).map((li) => li.innerText),
    places: all(".places li").map((li) => li.textContent),
  };
}"""


@pytest.mark.parametrize(("device", "theme"), [("phone", "dark"), ("desk", "light")])
@pytest.mark.nightly
async def test_several_robots_do_not_hide_each_other_and_drawing_and_list_say_the_same(visit, device, theme):
    ada = await visit(on=device, color_scheme=theme)
    page = ada.page
    await page.goto("/")
    await expect(page.get_by_role("heading", name="Send a letter")).to_be_visible()
    track = as_sent(builtin_map("test_track"))
    for corridor in track["corridors"]:
        corridor["network"] = corridor["name"] != "post3-post4"
    await drawn(page, track, FOUR, TAKEN)
    told = await page.locator("campus-map").evaluate(TOLD)
    assert sorted(told["seen"]) == [
        ["r1", "post3", "offline"],
        ["r2", "post3", "stopped"],
        ["r3", "post5", "charging"],
        ["r4", "post5", ""],
    ]
    assert [(a, b) for i, a in enumerate(told["robots"]) for b in told["robots"][:i] if overlap(a, b)] == []
    covered = [
        (a, b) for i, (a, at_a) in enumerate(told["labels"]) for b, at_b in told["labels"][:i] if overlap(at_a, at_b)
    ]
    assert covered == []
    notes = " / ".join(text for text, _ in told["labels"])
    for said in ("r1 · offline", "r2 · stopped", "r3 · charging", "r4 · 2 min"):
        assert said in notes

    title = {post["name"]: post["title"] for post in track["posts"]}
    lists = {text.splitlines()[0].removeprefix("Robot "): text for text in told["lists"]}
    for robot, post, condition in told["seen"]:
        assert f"Last seen at {title[post]}, 2 min" in lists[robot]
        word = {
            "offline": "Offline, as expected: there is no network",
            "stopped": "Stopped; needs help",
            "charging": ", charging; 80% at about",
        }
        assert [kind for kind, said in word.items() if said in lists[robot]] == [condition or None][: bool(condition)]
    assert sorted(told["expected"]) == [["r1", "post4"], ["r4", "post3"]]
    assert sorted(told["taken"]) == [["r1", "post3-post4"], ["r4", "post3-post5"]], "not of a robot that is not shown"
    for name, text in lists.items():
        assert ("Expected at" in text) == (name in {"r1", "r4"})
        held = [f"corridor from {title[a]} to {title[b]}, since " for robot, a, b in TAKEN if robot == name]
        assert text.count("May be in the corridor") == len(held) == sum(one in text for one in held)
    assert "A person stopped the robot." in lists["r2"], "why"
    assert told["silent"] == ["post3-post4"]
    assert "No network between Post 3 and Post 4" in told["places"]
    assert told["places"][0] == "Post 1 (bay 1: home, bay 2): 2 m to Post 2"
    await expect(page.get_by_text("No network: robots are offline here")).to_be_visible()
    await ada.assert_accessible()
