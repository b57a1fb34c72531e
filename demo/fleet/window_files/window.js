/** Reported and true positions on the product's map, and the processes of the robots. Of the demonstration alone. */
import { html, nothing, render, svg } from "lit";
import { CampusMapElement } from "/src/map/campus_map.js";
import { drawnBays } from "/src/map/map_bays.js";
import { along, pointsFrom } from "/src/map/map_drawing.js";
import { tellServerTime } from "/src/service/server_clock.js";
import { chooseLanguage, loadTexts } from "/src/texts/texts.js";
import { TEXTS } from "./texts.js";

const EVERY_MS = 500;
const language = chooseLanguage(navigator.languages, Object.keys(TEXTS));
const say = (key, values = {}) => TEXTS[language][key].replace(/\{(\w+)\}/g, (_, name) => values[name]);
const RING = svg`<circle r="15" /><path d="M15 0h6" />`;

/** The product's map, and rings where bodies truly are. */
class FleetMap extends CampusMapElement {
  static properties = { truth: { attribute: false } };

  above(drawn) {
    return Object.entries(this.truth ?? {}).map(([robot, true_]) => {
      const { x, y } = placeOf(drawn, true_);
      const degrees = (-true_.heading_rad * 180) / Math.PI;
      return svg`<g class="true" data-true=${robot} transform="translate(${x.toFixed(1)} ${y.toFixed(1)})">
        <g transform="rotate(${degrees.toFixed(0)})">${RING}</g><text y="27" text-anchor="middle">${robot}</text>
      </g>`;
    });
  }
}
customElements.define("fleet-map", FleetMap);

/** A place on the track as it is drawn: spurs are drawn longer than they are. */
function placeOf(drawn, { a, b, part }) {
  const way = pointsFrom(drawn, a, b);
  if (way.length) return along(way, part);
  for (const post of drawn.posts) {
    const bay = drawnBays(post).find(({ name }) => name === a || name === b);
    const out = bay?.name === b ? part : 1 - part;
    if (bay) return { x: post.x + bay.x * out, y: post.y + bay.y * out };
  }
  return { x: 0, y: 0 };
}

async function answer(path, options) {
  const got = await fetch(path, options);
  if (!got.ok) throw new Error(`${path}: ${got.status}`);
  return got.json();
}
const order = (robot, what) => answer(`robots/${robot}/${what}`, { method: "POST" }).then(look);
const shown = { map: null, state: null, truth: true, gone: false };

function draw() {
  const { map, state, truth, gone } = shown;
  const robots = state?.robots ?? [];
  render(
    html`<h1>${say("title")}</h1>
      <p>${say("hint")}</p>
      ${gone ? html`<p class="differs" role="alert">${say("gone")}</p>` : nothing}
      <label class="switch"><input type="checkbox" role="switch" .checked=${truth} @change=${turn} />${say("switch")}</label>
      <div class="both">
        <div>
          <fleet-map .map=${map} .robots=${robots} .traffic=${state?.traffic.taken ?? []}
            .reported=${state?.traffic.reported ?? []} .alarms=${state?.alarms ?? []} .truth=${truth ? (state?.true ?? {}) : {}}></fleet-map>
          ${truth ? kinds() : nothing}
        </div>
        <div class="scroll">${state ? [table(robots, state, truth), alarms(state.alarms)] : nothing}</div>
      </div>`,
    document.querySelector("#window"),
  );
}

const kinds = () => html`<ul class="kinds">
  <li><svg viewBox="-18 -18 36 36" class="campus" aria-hidden="true"><g class="robot"><circle class="body" r="11" /></g></svg><span>${say("believed")}</span></li>
  <li><svg viewBox="-20 -22 44 44" aria-hidden="true"><g class="true">${RING}</g></svg><span class="of-truth">${say("true")}</span></li>
</ul>`;

const table = (robots, state, truth) => html`<table>
  <thead><tr>${["robot", "process", "reports", ...(truth ? ["truly", "compared"] : [])].map((key) => html`<th scope="col">${say(key)}</th>`)}</tr></thead>
  <tbody>${robots.map(({ name }) => row(name, state, truth))}</tbody>
</table>`;

function row(name, { traffic, true: truths, processes }, truth) {
  const reported = traffic.reported.find(({ robot }) => robot === name);
  const [true_, process] = [truths[name], processes[name]];
  return html`<tr data-row=${name}>
    <th scope="row">${name}</th>
    <td>${process ? ofProcess(name, process) : nothing}</td>
    <td>${reported ? say(reported.kind, reported) : say("nothing")}</td>
    ${truth ? html`<td class="of-truth">${true_ ? truly(true_) : nothing}</td>
      <td class=${true_?.agreement ?? ""}>${true_?.agreement ? say(true_.agreement) : nothing}</td>` : nothing}
  </tr>`;
}

function truly({ places, a, b, beside_m }) {
  const beside = beside_m > 0.1 ? say("beside", { cm: Math.round(100 * beside_m) }) : "";
  return places.map(([kind, place]) => say(kind === "corridor" ? "line" : kind, { place, a, b })).join(" + ") + beside;
}

const ofProcess = (name, { number, runs }) =>
  runs
    ? html`${say("runs", { number })}<br /><button type="button" class="quiet" @click=${() => order(name, "kill")}>${say("kill")}</button>`
    : html`<span class="down">${say("down")}</span><br /><button type="button" class="quiet" @click=${() => order(name, "start")}>${say("start")}</button>`;

const alarms = (open) => (open.length ? html`<h2>${say("alarms")}</h2><ul>${open.map(({ robot, reason }) => html`<li>${robot}: ${reason}</li>`)}</ul>` : nothing);

function turn({ target }) {
  shown.truth = target.checked;
  draw();
}

async function look() {
  try {
    shown.map ??= await answer("map");
    shown.state = await answer("state");
    shown.gone = false;
    tellServerTime(shown.state.now);
  } catch {
    shown.gone = true;
  }
  draw();
}

await loadTexts(language);
document.title = say("title");
for (;;) {
  await look();
  await new Promise((later) => setTimeout(later, EVERY_MS));
}
