// The player of a recorded run. Everything on the page is made from DATA by createElement and textContent: nothing in a
// recording can become markup.
"use strict";
const rows = JSON.parse(document.getElementById("data").textContent);
const head = rows[0];
const byId = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";
const TOP_SPEED = 200;
const SKILLS = { follow_line: "#2f7ed8", turn: "#8a63d2", search: "#d98a00", find_line: "#d98a00", dock: "#00aa99",
  undock: "#55ccbb" };

function draw(parent, name, attributes = {}, text = null) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== null) element.textContent = text;
  parent.append(element);
  return element;
}

function make(parent, name, text = "", className = "") {
  const element = document.createElement(name);
  element.textContent = text;
  if (className) element.className = className;
  parent.append(element);
  return element;
}

// What is true of a robot at a time: the rows of its kinds in order, found by halving.
const of = (kind, robot) => rows.filter((row) => row.kind === kind && (robot === null || row.robot === robot));
function at(list, time) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle].t <= time) low = middle + 1; else high = middle;
  }
  return low ? list[low - 1] : null;
}

const tracks = new Map(head.robots.map((name) => [name, {
  states: of("state", name), why: of("why", name), doing: of("doing", name), percepts: of("percepts", name),
  faults: of("fault", name), events: of("event", name),
}]));
const people = of("people", null), mail = of("mail", null), events = of("event", null), end = rows.find((row) => row.kind === "end");
const last_s = Math.max(1, ...rows.map((row) => row.t || 0));
let chosen = head.robots[0], now_s = 0, playing = null;

// The map -------------------------------------------------------------------------------------------------------------

const map = byId("map");
const xs = [], ys = [];
for (const [, tape] of head.map.corridors) for (const [x, y] of tape) { xs.push(x); ys.push(y); }
for (const [x, y] of head.map.docks) { xs.push(x); ys.push(y); }
const EDGE_M = 0.7;
const box = { x: Math.min(...xs) - EDGE_M, y: Math.min(...ys) - EDGE_M };
box.w = Math.max(...xs) + EDGE_M - box.x; box.h = Math.max(...ys) + EDGE_M - box.y;
map.setAttribute("viewBox", `${box.x} ${-(box.y + box.h)} ${box.w} ${box.h}`);
const unit = Math.max(box.w, box.h) / 100; // lettering and strokes in proportion to the campus
const flip = (points) => points.map(([x, y]) => `${x},${-y}`).join(" ");
const hue = (speed) => `hsl(${Math.round(8 + 132 * Math.min(1, Math.abs(speed) / TOP_SPEED))} 80% 42%)`;

function drawPlace(place, className) {
  if (place.tape) draw(map, "polyline", { points: flip(place.tape), class: `${className}-tape`, "stroke-width": 0.5 });
  else if (place.at) draw(map, "circle", { cx: place.at[0], cy: -place.at[1], r: place.radius, class: className });
}
head.no_network.forEach((place) => drawPlace(place, "offline"));
head.dark.forEach((place) => drawPlace(place, "dark"));
for (const [, tape] of head.map.corridors) draw(map, "polyline", { points: flip(tape), class: "tape", "stroke-width": Math.max(0.024, unit / 4) });
for (const [x, y, heading] of head.map.docks) {
  const dock = draw(map, "g", { transform: `translate(${x} ${-y}) rotate(${-heading * 180 / Math.PI})` });
  draw(dock, "path", { d: "M -.1 -.22 H .24 V .22 H -.1", class: "dock", "stroke-width": unit / 5 });
}
for (const [x, y, heading] of head.map.markers) {
  const dx = -Math.sin(heading) * 0.06, dy = Math.cos(heading) * 0.06;
  draw(map, "line", { x1: x - dx, y1: -(y - dy), x2: x + dx, y2: -(y + dy), class: "marker", "stroke-width": unit / 3 });
}

// The way, in pieces of one colour: a polyline for every stretch of about the same speed.
function drawWay(states) {
  const group = draw(map, "g");
  let piece = [], colour = null;
  const flush = () => { if (piece.length > 1) draw(group, "polyline", { points: flip(piece), class: "way", stroke: colour, "stroke-width": unit / 2.5 }); };
  for (const state of states) {
    const next = hue(Math.round(state.speed / 25) * 25), before = piece[piece.length - 1];
    if (before && Math.hypot(before[0] - state.x, before[1] - state.y) > 0.3) { flush(); piece = []; } // carried
    if (next !== colour) { flush(); piece = piece.slice(-1); colour = next; }
    piece.push([state.x, state.y]);
  }
  flush();
  return group;
}
const ways = new Map([...tracks].map(([name, track]) => [name, drawWay(track.states)]));
for (const [name, x, y] of head.map.posts) {
  draw(map, "circle", { cx: x, cy: -y, r: unit * 0.9, class: "post", "stroke-width": unit / 4 });
  draw(map, "text", { x: x + unit * 1.4, y: -y - unit * 1.2 }, name).style.fontSize = `${unit * 2.4}px`;
}
const crowd = draw(map, "g");
const bodies = new Map(head.robots.map((name, number) => {
  const body = draw(map, "g", { class: "robot" });
  draw(body, "circle", { r: Math.max(0.174, unit * 1.4), fill: `hsl(${200 + 70 * number} 70% 45%)`, opacity: 0.85 });
  draw(body, "path", { d: "M 0 -.09 L .15 0 L 0 .09 Z", fill: "#fff", transform: `scale(${Math.max(1, unit * 8)})` });
  body.addEventListener("click", () => choose(name));
  return [name, body];
}));
const legend = byId("legend");
for (const [colour, words] of [[hue(0), "standing"], [hue(100), "100 mm/s"], [hue(200), "200 mm/s"], ["var(--person)", "person"], ["#0004", "dark"], ["var(--radio)", "no network"],
  ["#2f7ed8", "follows the line"], ["#8a63d2", "turns"], ["#d98a00", "looks for the line"], ["#00aa99", "docks, undocks"]]) {
  const entry = make(legend, "span");
  make(entry, "i").style.background = colour;
  entry.append(words);
}

// The time axis -------------------------------------------------------------------------------------------------------

const time = byId("time");
const WIDTH = 1200, LEFT = 92, LANES = [["line", 22], ["skill", 14], ["battery", 26], ["network", 8], ["faults", 16], ["told", 16]];
const axis_px = (t) => LEFT + (WIDTH - LEFT - 12) * t / last_s;
const height = LANES.reduce((sum, [, lane]) => sum + lane + 5, 22);
time.setAttribute("viewBox", `0 0 ${WIDTH} ${height}`);
const lanes = draw(time, "g");

// Runs of equal values become one bar each.
function bars(lane, states, value, paint, y, tall) {
  let begin = null;
  const close = (until) => {
    if (begin && value(begin)) draw(lane, "rect", { x: axis_px(begin.t), y, width: Math.max(0.4, axis_px(until) - axis_px(begin.t)), height: tall, ...paint(value(begin)) });
  };
  for (const state of states) if (!begin || value(state) !== value(begin)) { close(state.t); begin = state; }
  close(last_s);
}

function drawLanes() {
  lanes.replaceChildren();
  const track = tracks.get(chosen);
  let y = 4;
  const draws = {
    line: (top) => [0, 1, 2].forEach((diode) => bars(lanes, track.states, (state) => state.line[diode] === "0", () => ({ class: "lit" }), top + diode * 7.5, 6)),
    skill: (top, tall) => bars(lanes, track.states, (state) => state.skill, (skill) => ({ fill: SKILLS[skill] || "#789" }), top, tall),
    battery: (top, tall) => draw(lanes, "polyline", { class: "battery", points: track.states.map((state) => `${axis_px(state.t)},${top + tall * (1 - state.battery)}`).join(" ") }),
    network: (top, tall) => bars(lanes, track.states, (state) => !state.online, () => ({ class: "radio-off" }), top, tall),
    faults: (top, tall) => drawFaults(track.faults, top, tall),
    told: (top, tall) => track.events.forEach((event) => draw(draw(lanes, "line", { x1: axis_px(event.t), x2: axis_px(event.t), y1: top, y2: top + tall, class: isLoud(event) ? "event loud" : "event" }), "title", {}, `${event.t} s: ${event.text}`)),
  };
  for (const [name, tall] of LANES) {
    draw(lanes, "text", { x: 8, y: y + tall / 2 + 4, class: "soft" }, name);
    draw(lanes, "line", { x1: LEFT, x2: WIDTH - 12, y1: y + tall + 2, y2: y + tall + 2, class: "lane-rule" });
    draws[name](y, tall);
    y += tall + 5;
  }
  const step = [5, 10, 30, 60, 120, 300, 600, 1800].find((one) => last_s / one <= 14) || 3600;
  for (let t = 0; t <= last_s; t += step) draw(lanes, "text", { x: axis_px(t), y: height - 5, class: "soft", "text-anchor": "middle" }, `${t} s`);
}

function drawFaults(faults, top, tall) {
  for (const fault of faults.filter((row) => row.on)) {
    const over = faults.find((row) => row.name === fault.name && !row.on && row.t >= fault.t);
    const bar = draw(lanes, "rect", { x: axis_px(fault.t), y: top, width: Math.max(1.5, axis_px(over ? over.t : last_s) - axis_px(fault.t)), height: tall, class: "fault" });
    draw(bar, "title", {}, `${fault.name}, ${fault.t} s`);
  }
}
const cursor = draw(time, "line", { y1: 0, y2: height - 18, class: "cursor" });
const isLoud = (event) => /fault|failed|gave_up|somebody|service:/.test(event.text);

// Now -----------------------------------------------------------------------------------------------------------------

const lines = events.map((event) => {
  const line = make(byId("events"), "li");
  make(line, "time", `${event.t.toFixed(1)} s`);
  make(line, "span", head.robots.length > 1 ? `${event.robot}: ${event.text}` : event.text);
  line.addEventListener("click", () => show(event.t));
  return line;
});

function facts(track, state) {
  const doing = at(track.doing, now_s), why = at(track.why, now_s);
  const has = [...new Set(mail.filter((row) => row.t <= now_s).map((row) => row.robot))]
    .filter((order) => at(mail.filter((row) => row.robot === order), now_s).value === chosen);
  const active = track.faults.filter((row) => row.on && row.t <= now_s && !track.faults.some((over) => over.name === row.name && !over.on && over.t > row.t && over.t <= now_s));
  return [
    ["says", why ? why.value : ""], ["does", doing ? doing.value.join(", ") || "–" : ""],
    ["believes", `${state.at || "nowhere"}${state.towards ? `, towards ${state.towards}` : ""}`],
    ["speed", `${state.speed} mm/s`], ["line", state.line.replaceAll("0", "■").replaceAll("1", "□")],
    ["battery", `${(100 * state.battery).toFixed(1)} %${state.docked ? ", in the dock" : ""}`],
    ["network", state.online ? "yes" : "no"], ["mail aboard", has.join(", ") || "–"],
    ["faults", active.map((row) => row.name).join(", ") || "–"],
  ];
}

function showPercepts(track) {
  const list = byId("percepts"), present = at(track.percepts, now_s);
  list.replaceChildren();
  const before = present ? at(track.percepts, present.t - 0.001) : null;
  for (const percept of present ? present.value : []) {
    make(list, "span", percept, before && !before.value.includes(percept) && now_s - present.t < 1 ? "new" : "");
    list.append(" ");
  }
}

function show(t) {
  now_s = Math.min(Math.max(t, 0), last_s);
  byId("slider").value = now_s;
  byId("clock").textContent = `${now_s.toFixed(1)} of ${last_s.toFixed(0)} s`;
  cursor.setAttribute("x1", axis_px(now_s)); cursor.setAttribute("x2", axis_px(now_s));
  for (const [name, body] of bodies) {
    const state = at(tracks.get(name).states, now_s);
    if (state) body.setAttribute("transform", `translate(${state.x} ${-state.y}) rotate(${-state.heading * 180 / Math.PI})`);
  }
  crowd.replaceChildren();
  for (const [x, y, r] of (at(people, now_s) || { value: [] }).value) draw(crowd, "circle", { cx: x, cy: -y, r, class: "person" });
  const track = tracks.get(chosen), state = at(track.states, now_s);
  byId("now").replaceChildren();
  if (state) for (const [name, value] of facts(track, state)) { make(byId("now"), "dt", name); make(byId("now"), "dd", value); }
  showPercepts(track);
  let present = null;
  lines.forEach((line, number) => { line.className = events[number].t <= now_s ? "past" : ""; if (events[number].t <= now_s) present = line; });
  if (present) { present.className = "past present"; const list = byId("events"); list.scrollTop = present.offsetTop - list.offsetTop - list.clientHeight / 2; }
}

function choose(name) {
  chosen = name;
  for (const button of byId("robots").children) button.setAttribute("aria-selected", String(button.textContent === name));
  for (const [robot, way] of ways) way.setAttribute("opacity", robot === name ? 1 : 0.25);
  drawLanes();
  show(now_s);
}

// Controls ------------------------------------------------------------------------------------------------------------

function play(on) {
  if (playing) { cancelAnimationFrame(playing); playing = null; }
  byId("play").textContent = on ? "⏸" : "▶";
  if (!on) return;
  let before = performance.now();
  const tick = (moment) => {
    show(now_s + (moment - before) / 1000 * Number(byId("speed").value));
    before = moment;
    if (now_s >= last_s) play(false); else playing = requestAnimationFrame(tick);
  };
  playing = requestAnimationFrame(tick);
}
byId("play").addEventListener("click", () => play(!playing));
byId("slider").max = last_s;
byId("slider").addEventListener("input", (event) => show(Number(event.target.value)));
time.addEventListener("click", (event) => {
  const bounds = time.getBoundingClientRect();
  show(((event.clientX - bounds.left) * WIDTH / bounds.width - LEFT) / (WIDTH - LEFT - 12) * last_s);
});
document.addEventListener("keydown", (event) => {
  if (event.target.matches("input, select, button") && event.key !== " ") return;
  const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -30, PageDown: 30 }[event.key];
  if (step) show(now_s + step); else if (event.key === " ") play(!playing); else return;
  event.preventDefault();
});

byId("title").textContent = head.title || "A run";
byId("about").textContent = [head.about, `${head.map.title}, seed ${head.seed}`].filter(Boolean).join(" · ");
if (end) {
  const fates = Object.entries(end.fates).map(([order, [fate, why]]) => `${order}: ${fate}${why ? ` (${why})` : ""}`);
  byId("result").textContent = [...fates, ...end.not_as_expected].join(" · ") || "ended as expected";
  byId("result").className = end.not_as_expected.length ? "bad" : "good";
}
if (head.robots.length > 1) for (const name of head.robots) make(byId("robots"), "button", name).addEventListener("click", () => choose(name));
choose(chosen);
show(location.hash ? Number(location.hash.slice(1)) || 0 : 0);
