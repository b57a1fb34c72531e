
// The map -------------------------------------------------------------------------------------------------------------

const map = byId("map");
const TOP_SPEED = 200;
const corners = [...head.map.corridors.flatMap(([, tape]) => tape), ...head.map.docks];
const [xs, ys] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
const EDGE_M = Math.max(0.7, 0.06 * (Math.max(...xs) - Math.min(...xs)), 0.06 * (Math.max(...ys) - Math.min(...ys)));
const whole = { x: Math.min(...xs) - EDGE_M, y: -Math.max(...ys) - EDGE_M };
whole.w = Math.max(...xs) + EDGE_M - whole.x; whole.h = EDGE_M - Math.min(...ys) - whole.y;
const unit = Math.max(whole.w, whole.h) / 100; // lettering and strokes in proportion to the campus
const flip = (points) => points.map(([x, y]) => `${x},${-y}`).join(" ");

let box = { ...whole };
const LETTERS_PX = 12.5;
function showBox() {
  map.setAttribute("viewBox", `${box.x} ${box.y} ${box.w} ${box.h}`);
  const scale = map.getScreenCTM();
  if (!scale) return;
  map.style.fontSize = `${LETTERS_PX / scale.a}px`; // as large on a phone and in a corner of a large campus
  placeNames(LETTERS_PX / scale.a);
}

// Each name beside its post: at the first of four corners where it covers no name that has its place.
const CORNERS = [[1, -0.7], [1, 1.5], [-1, -0.7], [-1, 1.5]];
const names = [];
function placeNames(em) {
  const taken = [];
  for (const { text, x, y } of names) {
    const long = 0.56 * em * text.textContent.length;
    const boxAt = ([side, down]) => ({ x: side > 0 ? x + 0.8 * em : x - 0.8 * em - long, y: y + down * em - em });
    const isFree = (corner) => taken.every((one) => Math.abs(one.y - boxAt(corner).y) > 1.1 * em || one.x + one.long < boxAt(corner).x || boxAt(corner).x + long < one.x);
    const corner = CORNERS.find(isFree) || CORNERS[0];
    taken.push({ ...boxAt(corner), long });
    for (const [key, value] of Object.entries({ dx: `${0.8 * corner[0]}em`, dy: `${corner[1]}em`, "text-anchor": corner[0] > 0 ? "start" : "end" })) text.setAttribute(key, value);
  }
}
function zoomMap(factor, x = box.x + box.w / 2, y = box.y + box.h / 2) {
  const w = Math.min(whole.w, Math.max(1.5, box.w * factor)), share = w / box.w;
  box = share >= 1 && w === whole.w ? { ...whole } : { x: x - (x - box.x) * share, y: y - (y - box.y) * share, w, h: box.h * share };
  showBox();
}
const onMap = (event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(map.getScreenCTM().inverse());
map.addEventListener("wheel", (event) => {
  const point = onMap(event);
  zoomMap(event.deltaY < 0 ? 0.8 : 1.25, point.x, point.y);
  event.preventDefault();
}, { passive: false });
map.addEventListener("dblclick", () => zoomMap(Infinity));
let held = null;
map.addEventListener("pointerdown", (event) => { held = box.w < whole.w ? onMap(event) : null; });
map.addEventListener("pointermove", (event) => {
  if (!held || !event.buttons) return;
  const point = onMap(event);
  box.x += held.x - point.x; box.y += held.y - point.y;
  showBox();
});
new ResizeObserver(showBox).observe(map);

// Orange to blue, so that those who see no red from green can read it too.
const STOPS = [[217, 83, 25], [170, 120, 165], [30, 115, 210]];
function speedColour(speed) {
  const place = Math.min(1.999, 2 * Math.abs(speed) / TOP_SPEED), from = STOPS[Math.floor(place)], to = STOPS[Math.floor(place) + 1];
  return `rgb(${from.map((one, channel) => Math.round(one + (to[channel] - one) * (place % 1))).join(" ")})`;
}

function drawPlace(place, className) {
  if (place.tape) draw(map, "polyline", { points: flip(place.tape), class: `${className}-tape`, "stroke-width": 0.5 });
  else if (place.at) draw(map, "circle", { cx: place.at[0], cy: -place.at[1], r: place.radius, class: className });
}
head.no_network.forEach((place) => drawPlace(place, "offline"));
head.dark.forEach((place) => drawPlace(place, "dark"));
for (const [name, tape] of head.map.corridors) draw(draw(map, "polyline", { points: flip(tape), class: "tape", "stroke-width": Math.max(0.024, unit / 4) }), "title", {}, name);
for (const [x, y, heading] of head.map.docks) {
  const dock = draw(map, "g", { transform: `translate(${x} ${-y}) rotate(${-heading * 180 / Math.PI})` });
  draw(draw(dock, "path", { d: "M -.1 -.22 H .24 V .22 H -.1", class: "dock", "stroke-width": unit / 5 }), "title", {}, "dock");
}
for (const [x, y, heading] of head.map.markers) {
  const dx = -Math.sin(heading) * 0.06, dy = Math.cos(heading) * 0.06;
  draw(map, "line", { x1: x - dx, y1: -(y - dy), x2: x + dx, y2: -(y + dy), class: "marker", "stroke-width": unit / 3 });
}

// The way, in pieces of one colour. Pieces that are still to come are faint; the piece under way grows.
const LONGEST_PIECE = 50;
function piecesOf(states) {
  const pieces = [];
  let piece = null;
  for (const [number, state] of states.entries()) {
    const before = states[number - 1], colour = speedColour(Math.round(state.speed / 25) * 25);
    const carried = before && Math.hypot(before.x - state.x, before.y - state.y) > CARRIED_M;
    if (!piece || carried || colour !== piece.colour || piece.states.length > LONGEST_PIECE) {
      piece = { colour, states: piece && !carried ? [before] : [] };
      pieces.push(piece);
    }
    piece.states.push(state);
  }
  return pieces;
}
const points = (states) => flip(states.map((state) => [state.x, state.y]));
function drawWay(states) {
  const group = draw(map, "g");
  const pieces = piecesOf(states).map((piece) => ({ ...piece, from: piece.states[0].t, until: piece.states.at(-1).t,
    line: draw(group, "polyline", { points: points(piece.states), class: "way", stroke: piece.colour, "stroke-width": unit / 2.2 }) }));
  return { group, pieces, live: draw(group, "polyline", { class: "way past", "stroke-width": unit / 2.2 }) };
}
const ways = new Map([...tracks].map(([name, track]) => [name, drawWay(track.states)]));
function showWay(way, time) {
  way.live.setAttribute("points", "");
  for (const piece of way.pieces) {
    piece.line.classList.toggle("past", piece.until <= time);
    if (piece.from > time || piece.until <= time) continue;
    way.live.setAttribute("points", points([...piece.states.slice(0, indexAt(piece.states, time) + 1), poseAt(piece.states, time)]));
    way.live.setAttribute("stroke", piece.colour);
  }
}

for (const [name, x, y] of head.map.posts) {
  draw(map, "circle", { cx: x, cy: -y, r: unit * 0.9, class: "post", "stroke-width": unit / 4 });
  names.push({ text: draw(map, "text", { x, y: -y }, name), x, y: -y });
}
const crowd = draw(map, "g");
const bodies = new Map(head.robots.map((name, number) => {
  const body = draw(map, "g", { class: "robot" }), radius = Math.max(0.174, unit * 1.4);
  draw(body, "circle", { class: "halo", r: radius * 1.35 });
  draw(body, "circle", { r: radius, fill: `hsl(${200 + 70 * number} 70% 45%)`, opacity: 0.9 });
  draw(body, "path", { d: "M -.06 -.09 L .12 0 L -.06 .09 Z", fill: "#fff", transform: `scale(${radius / 0.174})` });
  draw(body, "title", {}, name);
  body.addEventListener("click", () => choose(name));
  return [name, body];
}));

function showMap(time) {
  for (const [name, body] of bodies) {
    const states = tracks.get(name).states;
    if (!states.length) continue;
    const pose = poseAt(states, time);
    body.setAttribute("transform", `translate(${pose.x} ${-pose.y}) rotate(${-pose.heading * 180 / Math.PI})`);
    showWay(ways.get(name), time);
  }
  crowd.replaceChildren();
  for (const [x, y, r] of (at(people, time) || { value: [] }).value) draw(draw(crowd, "circle", { cx: x, cy: -y, r, class: "person" }), "title", {}, "a person");
}

const inLegend = [["speed", "way driven: standing to 200 mm/s"], ["person", "person", people.some((row) => row.value.length)],
  ["dark", "little light", head.dark.length], ["no-network", "no network", head.no_network.length], ["sheet", "marker"], ["berth", "dock", head.map.docks.length]];
for (const [className, words, occurs = true] of inLegend) {
  if (!occurs) continue;
  const entry = make(byId("legend"), "span");
  make(entry, "i", "", className);
  entry.append(words);
}
