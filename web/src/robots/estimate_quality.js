/** For those who look after robots: how good estimated arrivals were, and how long corridors and stops take. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { titleOf } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { counted, t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { decimal, percent } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, EstimateQuality as Quality } from "../../types/api_types.ts" */

const POLL_MS = 60_000;

export class EstimateQuality extends PageElement {
  static properties = { map: { attribute: false }, quality: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Quality | null} */
    this.quality = null;
    this.problem = "";
    this.fetched_ms = -POLL_MS;
    new Ticking(this, POLL_MS);
  }

  updated() {
    if (performance.now() > this.fetched_ms + POLL_MS) this.#fetch();
  }

  render() {
    const { quality, map } = this;
    return html`<section class="card quality" aria-labelledby="quality-title">
      <h2 id="quality-title">${t("quality.title")}</h2>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${quality && map ? html`${said(quality)} ${numbers(quality, map)}` : nothing}
    </section>`;
  }

  async #fetch() {
    this.fetched_ms = performance.now();
    try {
      [this.quality, this.problem] = [await api.estimateQuality(), ""];
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Quality} quality */
function said({ assumed, inside_meant, placed, under_way }) {
  const learned = assumed ? html`<p class="hint">${t("quality.assumed")}</p>` : nothing;
  if (!placed.scored && !under_way.scored) return html`<p>${t("quality.none")}</p>${learned}`;
  return html`${compared("placed", placed, inside_meant)} ${compared("under_way", under_way, inside_meant)} ${learned}`;
}

/** @param {"placed" | "under_way"} basis @param {Quality["placed"]} quality @param {number} meant */
function compared(basis, { scored, inside_ratio, told, by_map }, meant) {
  if (inside_ratio === null || !told || !by_map) return nothing;
  return html`<h3>${t(`quality.${basis}`)}</h3>
    <p>${counted("quality.scored", scored)} ${t("quality.inside", { ratio: percent(inside_ratio), meant: percent(meant) })}</p>
    <p>${t("quality.off", { told: percent(told.median_error_ratio), by_map: percent(by_map.median_error_ratio) })}</p>`;
}

/** @param {Quality} quality @param {CampusMap} map */
function numbers({ durations }, map) {
  if (!durations.length) return nothing;
  return html`<details>
    <summary>${t("quality.numbers")}</summary>
    <ul class="durations">${durations.map((one) => duration(one, map))}</ul>
  </details>`;
}

/** @param {Quality["durations"][number]} one @param {CampusMap} map */
function duration({ kind, name, from_post, to_post, p10_s, p50_s, p90_s, assumed_s, seen }, map) {
  const way = from_post && to_post && t("quality.way", { from: titleOf(map, from_post), to: titleOf(map, to_post) });
  const hours = name === "office hours" ? "office" : "other";
  return html`<li>
    <strong>${way || t(`quality.${kind}.${hours}`)}</strong>
    <span>${t("quality.takes", { usually: minutes(p50_s), from: minutes(p10_s), to: minutes(p90_s) })}</span>
    <span class="hint">${counted("quality.seen", seen)} ${t("quality.by_map", { assumed: minutes(assumed_s) })}</span>
  </li>`;
}

/** @param {number} seconds */
const minutes = (seconds) => decimal(seconds / 60, 1);

customElements.define("estimate-quality", EstimateQuality);
