// The player of a recorded run. Everything on the page is made from DATA by createElement and textContent: nothing in a
// recording can become markup. The files data, map, axis and player become one script, in this order.
"use strict";
const rows = JSON.parse(document.getElementById("data").textContent);
const head = rows[0];
const byId = (id) => document.getElementById(id);
const SVG = "http://www.w3.org/2000/svg";

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
function indexAt(list, time) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle].t <= time) low = middle + 1; else high = middle;
  }
  return low - 1;
}
const at = (list, time) => list[indexAt(list, time)] || null;

const tracks = new Map(head.robots.map((name) => [name, {
  states: of("state", name), why: of("why", name), doing: of("doing", name), percepts: of("percepts", name),
  faults: of("fault", name), events: of("event", name), intentions: of("intentions", name),
}]));
const people = of("people", null), mail = of("mail", null), events = of("event", null);
const end = rows.find((row) => row.kind === "end");
const last_s = Math.max(1, ...[...tracks.values()].flatMap((track) => track.states.slice(-1).map((row) => row.t)), end ? end.t : 0);
const isLoud = (text) => /fault|failed|gave_up|somebody|service:/.test(text) && !/ over$/.test(text);
let chosen = head.robots[0], now_s = 0;

// Between two states a robot moves evenly, unless a person carried it.
const CARRIED_M = 0.3;
function poseAt(states, time) {
  const number = indexAt(states, time), before = states[Math.max(0, number)], after = states[number + 1];
  if (!after || number < 0 || Math.hypot(after.x - before.x, after.y - before.y) > CARRIED_M) return before;
  const share = (time - before.t) / (after.t - before.t), mix = (a, b) => a + (b - a) * share;
  const turn = Math.atan2(Math.sin(after.heading - before.heading), Math.cos(after.heading - before.heading));
  return { x: mix(before.x, after.x), y: mix(before.y, after.y), heading: before.heading + turn * share };
}
