
// The time axis: one row for each thing that has a history -------------------------------------------------------------

const axis = byId("axis"), ruler = byId("ruler"), lanes = byId("lanes");
const LEFT = 96, RIGHT = 14, ROW = 15, GAP = 7;
const SKILLS = { follow_line: "#2f7ed8", turn: "#8a63d2", search: "#d98a00", find_line: "#d98a00", dock: "#00957f", undock: "#2ba393" };
let shown = { from: 0, until: last_s }, width = 0, cursors = [];
const axis_px = (t) => LEFT + (width - LEFT - RIGHT) * (t - shown.from) / (shown.until - shown.from);
const axis_s = (event) => shown.from + (event.clientX - lanes.getBoundingClientRect().left - LEFT) / (width - LEFT - RIGHT) * (shown.until - shown.from);
const clock = (t) => last_s < 600 ? `${Math.round(10 * t) / 10} s` : `${Math.floor(t / 60)}:${String(Math.round(t % 60)).padStart(2, "0")}`;

// Runs of equal values: [{ from, until, value }], without those that say nothing.
function spans(list, value) {
  const found = [];
  for (const row of list) {
    const next = value(row), last = found.at(-1);
    if (last && last.value === next) continue;
    if (last) last.until = row.t;
    found.push({ from: row.t, until: last_s, value: next });
  }
  return found.filter((span) => span.value);
}

function bar(span, y, tall, paint, label = "", tip = label) {
  const from = Math.max(LEFT, axis_px(span.from)), until = Math.min(width - RIGHT, axis_px(span.until));
  if (until < LEFT || from > width - RIGHT) return;
  const rect = draw(lanes, "rect", { x: from, y, width: Math.max(0.7, until - from), height: tall, rx: label ? 2 : 0, ...paint });
  rect.dataset.tip = `${tip}\n${clock(span.from)} to ${clock(span.until)} (${(span.until - span.from).toFixed(1)} s)`;
  const room = Math.floor((until - from - 6) / 6.1);
  if (label && room >= 3) draw(lanes, "text", { x: from + 4, y: y + tall / 2 + 3.6, class: paint.fill ? "label light" : "label" }, label.length > room ? `${label.slice(0, room - 1)}…` : label);
}

function curve(states, value, y, tall, className) {
  const inside = states.slice(Math.max(0, indexAt(states, shown.from)), indexAt(states, shown.until) + 2);
  const step = Math.max(1, Math.floor(inside.length / (2 * width)));
  const points = inside.filter((_, number) => number % step === 0).map((state) => `${Math.min(width - RIGHT, Math.max(LEFT, axis_px(state.t)))},${(y + tall * (1 - value(state))).toFixed(1)}`);
  draw(lanes, "polyline", { class: className, points: points.join(" ") });
}

// Percepts by name, one row each; what never changes (and the clock's tick) is in the list beside the map.
function perceptRows(track) {
  const split = (percept) => [percept.split("(")[0], percept.includes("(") ? percept.slice(percept.indexOf("(") + 1, -1) : "yes"];
  const names = [...new Set(track.percepts.flatMap((row) => row.value.map((percept) => split(percept)[0])))].filter((name) => name !== "watch").sort();
  const valueOf = (name) => (row) => row.value.map(split).filter(([one]) => one === name).map(([, value]) => value).join(" and ");
  return names.map((name) => [name, spans(track.percepts, valueOf(name))]).filter(([, found]) => found.length > 1 || found[0].until < last_s);
}

// Each intention is a stack: its first cause in the upper row, what it has come to below. Beside each other they get rows of their own.
function intentionRows(track) {
  const levels = new Map();
  track.intentions.forEach((row, index) => {
    const until = track.intentions[index + 1]?.t ?? last_s;
    for (const [number, stack] of row.value) stack.forEach((goal, depth) => {
      const bars = levels.get(number) || levels.set(number, []).get(number);
      const before = bars.findLast((one) => one.depth === depth);
      const goes_on = before && before.until === row.t && before.value === goal && before.above === stack.slice(0, depth).join();
      if (goes_on) before.until = until; else bars.push({ from: row.t, until, value: goal, depth, above: stack.slice(0, depth).join() });
    });
  });
  const free = []; // since when each row is
  for (const bars of levels.values()) {
    const tall = Math.max(...bars.map((one) => one.depth)) + 1, from = bars[0].from;
    let base = 0;
    while (free.slice(base, base + tall).some((since) => since > from)) base += 1;
    for (let row = 0; row < tall; row += 1) free[base + row] = Math.max(...bars.map((one) => one.until));
    for (const one of bars) one.row = base + one.depth;
  }
  return [[...levels.values()].flat(), free.length];
}

const heading = (y, words, tall) => draw(lanes, "text", { x: 8, y: y + tall / 2 + 4, class: "soft" }, words);
const rows_of = new Map([...tracks].map(([name, track]) => [name, { percepts: perceptRows(track), intentions: intentionRows(track) }]));
const readable = (goal) => goal.replace(/^\+!/, "").replaceAll('"', "");

const LANES = [
  ["speed", 26, (y, tall, track) => curve(track.states, (state) => Math.min(1, Math.abs(state.speed) / TOP_SPEED), y, tall, "speed")],
  ["line", 23, (y, tall, track) => ["left", "centre", "right"].forEach((diode, number) => spans(track.states, (state) => state.line[number] === "0").forEach((span) =>
    bar(span, y + number * 8, 6.5, { class: "lit" }, "", `${diode} diode over the line`)))],
  ["skill", ROW, (y, tall, track) => spans(track.states, (state) => state.skill).forEach((span) =>
    bar(span, y, tall, { fill: SKILLS[span.value] || "#66788a" }, span.value === "search" ? "looks for the line" : span.value))],
  ["intentions", null, (y, tall) => rows_of.get(chosen).intentions[0].forEach((one) =>
    bar(one, y + one.row * ROW, ROW - 1.5, { class: `goal depth-${Math.min(5, one.depth)}` }, readable(one.value), one.value))],
  ["faults", ROW, (y, tall, track) => faultSpans(track.faults).forEach((span) => bar(span, y, tall, { class: "fault", fill: "var(--bad)" }, span.value))],
  ["told", 16, (y, tall, track) => track.events.forEach((event) => drawEvent(event, y, tall))],
  ["mail aboard", ROW, (y, tall) => mailSpans().forEach((span) => bar(span, y, tall, { fill: "#7a6a2f" }, span.value))],
  ["battery", 20, (y, tall, track) => curve(track.states, (state) => state.battery, y, tall, "battery")],
  ["no network", 9, (y, tall, track) => spans(track.states, (state) => !state.online).forEach((span) => bar(span, y, tall, { class: "radio-off" }, "", "out of the network"))],
];

function faultSpans(faults) {
  return faults.filter((row) => row.on).map((row) => ({ from: row.t, value: row.name, until: faults.find((over) => over.name === row.name && !over.on && over.t >= row.t)?.t ?? last_s }));
}
const lettersAboard = (time) => [...new Set(mail.filter((row) => row.t <= time).map((row) => row.robot))]
  .filter((order) => at(mail.filter((row) => row.robot === order), time).value === chosen);
const mailSpans = () => spans(mail, (row) => lettersAboard(row.t).join(", "));
function drawEvent(event, y, tall) {
  const x = axis_px(event.t);
  if (x < LEFT || x > width - RIGHT) return;
  const mark = draw(lanes, "path", { d: `M ${x} ${y} V ${y + tall} M ${x - 3} ${y + tall / 2} L ${x} ${y + tall / 2 - 3} L ${x + 3} ${y + tall / 2} L ${x} ${y + tall / 2 + 3} Z`, class: isLoud(event.text) ? "event loud" : "event" });
  mark.dataset.tip = `${event.text}\n${clock(event.t)}`;
}

function drawLane(name, y, tall, content) {
  heading(y, name, Math.min(tall, 26));
  content(y, tall, tracks.get(chosen));
  draw(lanes, "line", { x1: 8, x2: width - RIGHT, y1: y + tall + 3, y2: y + tall + 3, class: "lane-rule" });
  return y + tall + GAP;
}

function drawAxis() {
  width = axis.clientWidth;
  lanes.replaceChildren(); ruler.replaceChildren();
  const own = rows_of.get(chosen);
  let y = 4;
  for (const [name, tall, content] of LANES) y = drawLane(name, y, tall ?? Math.max(1, own.intentions[1]) * ROW, content);
  draw(lanes, "text", { x: 8, y: y + 10, class: "chapter" }, "PERCEPTS");
  y += 16;
  for (const [name, found] of own.percepts) y = drawLane(name, y, ROW, (top, tall) => found.forEach((span) => bar(span, top, tall, { class: "percept" }, span.value, `${name}(${span.value})`.replace("(yes)", "")))) - 2;
  const long_s = shown.until - shown.from, room = Math.max(3, (width - LEFT) / 90);
  const step = [0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600].find((one) => long_s / one <= room) || 7200;
  for (let t = Math.ceil(shown.from / step) * step; t <= shown.until; t += step) {
    draw(ruler, "text", { x: axis_px(t), y: 14, class: "soft", "text-anchor": "middle" }, clock(t));
    draw(ruler, "line", { x1: axis_px(t), x2: axis_px(t), y1: 18, y2: 22, class: "lane-rule" });
  }
  draw(ruler, "line", { x1: 0, x2: width, y1: 21.5, y2: 21.5, class: "lane-rule" });
  for (const [svg, tall] of [[ruler, 22], [lanes, y]]) { svg.setAttribute("width", width); svg.setAttribute("height", tall); svg.setAttribute("viewBox", `0 0 ${width} ${tall}`); }
  cursors = [draw(ruler, "line", { y1: 0, y2: 22, class: "cursor" }), draw(lanes, "line", { y1: 0, y2: y, class: "cursor" })];
  showCursor();
}

function showCursor() {
  const x = axis_px(now_s), visible = x >= LEFT - 1 && x <= width - RIGHT + 1;
  for (const cursor of cursors) { cursor.setAttribute("x1", x); cursor.setAttribute("x2", x); cursor.style.display = visible ? "" : "none"; }
}

function zoomAxis(factor, around = now_s) {
  const long_s = Math.min(last_s, Math.max(2, (shown.until - shown.from) * factor));
  const share = (around - shown.from) / (shown.until - shown.from);
  panAxis(around - share * long_s, long_s);
}
function panAxis(from, long_s = shown.until - shown.from) {
  const begin = Math.min(Math.max(0, from), last_s - long_s);
  shown = { from: begin, until: begin + long_s };
  drawAxis();
}
