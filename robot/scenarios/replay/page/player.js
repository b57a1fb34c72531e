
// Now -----------------------------------------------------------------------------------------------------------------

const lines = events.map((event) => {
  const line = make(byId("events"), "li", "", isLoud(event.text) ? "loud" : "");
  make(line, "time", clock(event.t));
  make(line, "span", head.robots.length > 1 ? `${event.robot}: ${event.text}` : event.text);
  line.addEventListener("click", () => show(event.t));
  return line;
});

function facts(track, state) {
  const doing = at(track.doing, now_s), why = at(track.why, now_s);
  const active = faultSpans(track.faults).filter((fault) => fault.from <= now_s && now_s < fault.until);
  return [
    ["says", why ? why.value : ""], ["does", doing ? doing.value.map(readable).join(", ") || "–" : ""],
    ["thinks it is", state.at ? `at ${state.at}${state.towards ? `, towards ${state.towards}` : ""}` : "somewhere"],
    ["speed", `${state.speed} mm/s`], ["line", state.line.replaceAll("0", "■").replaceAll("1", "□")],
    ["battery", `${(100 * state.battery).toFixed(1)} %${state.docked ? ", in the dock" : ""}`],
    ["network", state.online ? "yes" : "no"], ["mail aboard", lettersAboard(now_s).join(", ") || "–"],
    ["faults", active.map((fault) => fault.value).join(", ") || "–"],
  ];
}

function showIntentions(track) {
  const list = byId("intentions"), present = at(track.intentions, now_s);
  list.replaceChildren();
  for (const [, stack] of present ? present.value : []) stack.forEach((goal, depth) => {
    make(list, "li", readable(goal), depth === stack.length - 1 ? "top" : "").style.paddingLeft = `${0.7 * depth}em`;
  });
  if (!list.children.length) make(list, "li", track.intentions.length ? "nothing" : "not recorded", "none");
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

function showEvents() {
  const present = indexAt(events, now_s);
  lines.forEach((line, number) => { line.classList.toggle("past", number <= present); line.classList.toggle("present", number === present); });
  const list = byId("events"), line = lines[present];
  if (line) list.scrollTop = line.offsetTop - list.offsetTop - list.clientHeight / 2;
}

function show(t) {
  now_s = Math.min(Math.max(t, 0), last_s);
  byId("slider").value = now_s;
  byId("slider").setAttribute("aria-valuetext", clock(now_s));
  byId("clock").textContent = `${now_s.toFixed(1)} of ${last_s.toFixed(0)} s`;
  if (now_s > shown.until || now_s < shown.from) panAxis(now_s - (playing ? 0 : (shown.until - shown.from) / 2));
  showCursor();
  showMap(now_s);
  const track = tracks.get(chosen), state = at(track.states, now_s);
  byId("now").replaceChildren();
  if (state) for (const [name, value] of facts(track, state)) { make(byId("now"), "dt", name); make(byId("now"), "dd", value); }
  showIntentions(track);
  showPercepts(track);
  showEvents();
}

function choose(name) {
  chosen = name;
  for (const button of byId("robots").children) button.setAttribute("aria-pressed", String(button.textContent === name));
  for (const [robot, way] of ways) way.group.setAttribute("opacity", robot === name ? 1 : 0.25);
  for (const [robot, body] of bodies) body.classList.toggle("chosen", robot === name && head.robots.length > 1);
  drawAxis();
  show(now_s);
}

// Controls ------------------------------------------------------------------------------------------------------------

let playing = null;
function play(on) {
  if (playing) cancelAnimationFrame(playing);
  playing = null;
  byId("play").textContent = on ? "⏸" : "▶";
  if (!on) { keepPlace(); return; }
  if (now_s >= last_s) now_s = 0;
  let before = performance.now();
  const tick = (moment) => {
    playing = requestAnimationFrame(tick);
    show(now_s + Math.max(0, moment - before) / 1000 * Number(byId("speed").value));
    before = moment;
    if (now_s >= last_s) play(false);
  };
  playing = requestAnimationFrame(tick);
}

// The address names the moment, so that a colleague can be sent to it.
function keepPlace() {
  const place = `#${now_s.toFixed(1)}${head.robots.length > 1 ? `,${chosen}` : ""}`;
  try { history.replaceState(null, "", place); } catch { /* a browser that forbids it for files */ }
}
function findPlace() {
  const [time, robot] = decodeURIComponent(location.hash.slice(1)).split(",");
  if (tracks.has(robot)) choose(robot);
  show(Number(time) || 0);
}
function go(t) { show(t); if (!playing) keepPlace(); }
function nextEvent(direction) {
  const times = events.map((event) => event.t), found = direction > 0 ? times.find((t) => t > now_s + 0.05) : times.findLast((t) => t < now_s - 0.05);
  if (found !== undefined) go(found);
}

const KEYS = {
  " ": () => play(!playing), ArrowLeft: () => go(now_s - 1), ArrowRight: () => go(now_s + 1), PageUp: () => go(now_s - 30), PageDown: () => go(now_s + 30),
  Home: () => go(0), End: () => go(last_s), ",": () => go(now_s - 0.2), ".": () => go(now_s + 0.2), n: () => nextEvent(1), p: () => nextEvent(-1),
  "+": () => zoomAxis(0.5), "=": () => zoomAxis(0.5), "-": () => zoomAxis(2), 0: () => zoomAxis(Infinity),
  r: () => choose(head.robots[(head.robots.indexOf(chosen) + 1) % head.robots.length]),
};
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("select") || (event.key === " " && event.target.matches("button, summary"))) return;
  if (!Object.hasOwn(KEYS, event.key)) return;
  KEYS[event.key]();
  event.preventDefault();
});

byId("play").addEventListener("click", () => play(!playing));
byId("closer").addEventListener("click", () => zoomAxis(0.5));
byId("wider").addEventListener("click", () => zoomAxis(2));
byId("slider").max = last_s;
byId("slider").addEventListener("input", (event) => go(Number(event.target.value)));
axis.addEventListener("pointerdown", (event) => { if (event.clientX - lanes.getBoundingClientRect().left >= LEFT - 8 && event.target !== axis) go(axis_s(event)); });
axis.addEventListener("wheel", (event) => {
  if (!event.ctrlKey && !event.shiftKey) return; // it scrolls the lanes
  if (event.ctrlKey) zoomAxis(event.deltaY < 0 ? 0.8 : 1.25, axis_s(event)); else panAxis(shown.from + (event.deltaX || event.deltaY) / width * (shown.until - shown.from));
  event.preventDefault();
}, { passive: false });
axis.addEventListener("pointermove", (event) => {
  const tip = byId("tip");
  if (event.buttons && event.clientX - lanes.getBoundingClientRect().left >= LEFT) go(axis_s(event));
  tip.hidden = !event.target.dataset.tip;
  tip.textContent = event.target.dataset.tip || "";
  tip.style.left = `${Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)}px`;
  tip.style.top = `${event.clientY - tip.offsetHeight - 12}px`;
});
axis.addEventListener("pointerleave", () => { byId("tip").hidden = true; });
new ResizeObserver(() => { if (axis.clientWidth !== width) drawAxis(); }).observe(axis);
addEventListener("hashchange", findPlace);

byId("title").textContent = head.title || "A run";
byId("about").textContent = [head.about, `${head.map.title}, seed ${head.seed}`].filter(Boolean).join(" · ");
if (end) {
  const fates = Object.entries(end.fates).map(([order, [fate, why]]) => `${order}: ${fate}${why ? ` (${why})` : ""}`), good = !end.not_as_expected.length;
  byId("result").textContent = `${good ? "✓" : "✗"} ${[...fates, ...end.not_as_expected].join(" · ") || "ended as expected"}`;
  byId("result").className = good ? "good" : "bad";
} else byId("result").textContent = "the recording has no end: the run was cut off";
if (head.robots.length > 1) for (const name of head.robots) make(byId("robots"), "button", name).addEventListener("click", () => { choose(name); keepPlace(); });
choose(chosen);
findPlace();
