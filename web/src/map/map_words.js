/** A map in words: what its signs mean, and where its corridors lead. */
import { html, nothing, svg } from "lit";
import { bayMark, baysOf } from "./map_bays.js";
import { titleOf } from "../service/posts.js";
import { t } from "../texts/texts.js";
import { length } from "../texts/times.js";
import { NO_WAY } from "./map_parts.js";
/** @import { CampusMap, MapPost } from "../../types/api_types.ts" */
/** @import { MapFacts } from "./map_facts.js" */

const SIGNS = {
  bay: svg`<g transform="translate(14 9)">${bayMark(false, false)}</g>`,
  home: svg`<g transform="translate(14 9)">${bayMark(true, false)}</g>`,
  dock: svg`<g transform="translate(14 9) scale(0.9)">${bayMark(false, true)}</g>`,
  expected: svg`<circle class="expected" cx="14" cy="9" r="7" />`,
  taken: svg`<path class="taken-edge" d="M8 9h12" /><path class="taken" d="M8 9h12" /><path class="corridor" d="M1 9h26" />`,
  closed: svg`<path class="corridor" d="M1 9h26" /><g class="shut" transform="translate(14 9)">${NO_WAY}</g>`,
  silent: svg`<path class="hatch" d="M2 16 10 2M8 16 16 2M14 16 22 2M20 16 28 2" />`,
};

/** Of what is drawn now, and no more. @param {CampusMap} map @param {MapFacts} facts */
export function mapLegend(map, { expected, taken, shut, silent }) {
  const bays = map.posts.flatMap(baysOf);
  const ofBays = { bay: bays.some(({ home, dock }) => !home && !dock), home: bays.some(({ home }) => home), dock: bays.some(({ dock }) => dock) };
  const drawn = { ...ofBays, expected: expected.size, taken: taken.length, closed: shut.length, silent: silent.posts.length + silent.corridors.length };
  const signs = /** @type {(keyof typeof SIGNS)[]} */ (Object.keys(SIGNS)).filter((sign) => drawn[sign]);
  if (!signs.length) return nothing;
  return html`<ul class="legend">${signs.map(
    (sign) => html`<li><svg viewBox="0 0 28 18" aria-hidden="true">${SIGNS[sign]}</svg><span>${t(`map.legend.${sign}`)}</span></li>`,
  )}</ul>`;
}

/** @param {CampusMap} map */
export const placesInWords = (map) => html`<details class="places">
  <summary>${t("map.places")}</summary>
  <ul>${map.posts.map((post) => html`<li>${placeInWords(map, post)}</li>`)}${silentInWords(map).map((text) => html`<li>${text}</li>`)}</ul>
</details>`;

/** @param {CampusMap} map @param {MapPost} post */
function placeInWords(map, post) {
  const { name, title, dock } = post;
  const ways = map.corridors.flatMap(({ a, b, length_m, assumed }) => {
    const other = a === name ? b : b === name ? a : null;
    return other ? [t(assumed ? "map.way.assumed" : "map.way", { length: length(length_m), post: titleOf(map, other) })] : [];
  });
  const bays = baysOf(post);
  const values = { post: title, ways: ways.join(", ") };
  if (bays.length) return t("map.place.bays", { ...values, bays: bays.map((bay, i) => bayInWords(bay, i + 1)).join(", ") });
  return t(dock ? "map.place.dock" : "map.place", values);
}

/** @param {MapPost["bays"][number]} bay @param {number} number */
const bayInWords = ({ home, dock }, number) =>
  t(`map.bay.${home ? (dock ? "home_dock" : "home") : dock ? "dock" : "free"}`, { number });

/** @param {CampusMap} map */
const silentInWords = (map) => [
  ...map.posts.filter(({ network }) => !network).map(({ title }) => t("map.silent.post", { post: title })),
  ...map.corridors
    .filter(({ network }) => !network)
    .map(({ a, b }) => t("map.silent.corridor", { from: titleOf(map, a), to: titleOf(map, b) })),
];
