/** A robot's charge over time: a curve, and the same in words and numbers. */
import { html, nothing, svg } from "lit";
import * as api from "../service/api.js";
import { bands, charges, curve, fromItsFirst, height, HEIGHT, lowest, some, WIDTH } from "./battery_facts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { counted, t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { dayAndTime, percent } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { BatteryHistory } from "../../types/api_types.ts" */
/** @import { Charge, Sample } from "./battery_facts.js" */

const HOUR_MS = 3_600_000;
const SPANS = /** @type {const} */ ({ hours: 6 * HOUR_MS, day: 24 * HOUR_MS, week: 168 * HOUR_MS, month: 720 * HOUR_MS });
const POLL_MS = 60_000;
/** A robot that has just been switched on sends its first battery reading while the page is open. */
const FIRST_POLL_MS = 5_000;
const SLACK_MS = 100;
const ROWS = 13;

export class RobotBattery extends PageElement {
  static properties = {
    robot: { attribute: false },
    span: { state: true },
    history: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    this.robot = "";
    /** @type {keyof typeof SPANS} */
    this.span = "day";
    /** @type {BatteryHistory | null} */
    this.history = null;
    this.problem = "";
    this.fetched_ms = -POLL_MS;
    new Ticking(this, FIRST_POLL_MS);
  }

  /** @param {Map<string, unknown>} changed */
  updated(changed) {
    const again_ms = this.history?.samples.length ? POLL_MS : FIRST_POLL_MS;
    if (changed.has("span") || performance.now() > this.fetched_ms + again_ms - SLACK_MS) this.#fetch();
  }

  render() {
    const { history } = this;
    return html`<section aria-labelledby="battery-title">
      <div class="title-line">
        <h2 id="battery-title">${t("robots.battery")}</h2>
        <div class="choices" role="group" aria-label=${t("robots.battery.span")}>
          ${Object.keys(SPANS).map((span) => this.#button(/** @type {keyof typeof SPANS} */ (span)))}
        </div>
      </div>
      ${this.problem ? problemLine(this.problem) : nothing}
      <div class="battery">${history && (history.samples.length ? drawn(history) : html`<p class="empty">${t("robots.battery.none")}</p>`)}</div>
    </section>`;
  }

  /** @param {keyof typeof SPANS} span */
  #button(span) {
    return html`<button type="button" aria-pressed=${this.span === span ? "true" : "false"} @click=${() => (this.span = span)}>
      ${t(`robots.battery.span.${span}`)}
    </button>`;
  }

  async #fetch() {
    this.fetched_ms = performance.now();
    try {
      const since = new Date(serverNow() - SPANS[this.span]).toISOString();
      [this.history, this.problem] = [fromItsFirst(await api.batteryHistory(this.robot, since)), ""];
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {BatteryHistory} history */
function drawn(history) {
  const { samples, low_ratio, since, until } = history;
  const now_ms = serverNow();
  return html`<figure>
      <svg class="curve" viewBox="0 0 ${WIDTH} ${HEIGHT}" preserveAspectRatio="none" role="img" aria-labelledby="battery-said">
        ${bands(history).map(({ x, width }) => svg`<rect class="charging" x=${x} y="0" width=${width} height=${HEIGHT}/>`)}
        ${[0.25, 0.5, 0.75].map((ratio) => svg`<path class="grid" d="M0 ${height(ratio)}H${WIDTH}"/>`)}
        <path class="low" d="M0 ${height(low_ratio)}H${WIDTH}" />
        <path class="charge" d=${curve(history)} />
      </svg>
      <div class="scale" aria-hidden="true"><span>${percent(1)}</span><span>${percent(0.5)}</span><span>${percent(0)}</span></div>
      <div class="ends" aria-hidden="true"><span>${dayAndTime(since, now_ms)}</span><span>${dayAndTime(until, now_ms)}</span></div>
      <figcaption id="battery-said">${said(history)}</figcaption>
    </figure>
    <ul class="legend">
      <li class="of-charging">${t("robots.battery.charging")}</li>
      <li class="of-low">${t("robots.battery.low", { ratio: percent(low_ratio) })}</li>
    </ul>
    <details>
      <summary>${t("robots.battery.numbers")}</summary>
      ${table(samples, charges(history), now_ms)}
    </details>`;
}

/** @param {BatteryHistory} history */
function said(history) {
  const { samples } = history;
  const times = charges(history).length;
  const [first, low, last] = [samples[0], lowest(samples), samples[samples.length - 1]];
  const now_ms = serverNow();
  return [
    t("robots.battery.from_to", { from: percent(first.ratio), to: percent(last.ratio) }),
    t("robots.battery.lowest", { ratio: percent(low.ratio), time: dayAndTime(low.at, now_ms) }),
    times ? counted("robots.battery.charged", times) : "",
  ].join(" ");
}

/** @param {Sample[]} samples @param {Charge[]} times @param {number} now_ms */
function table(samples, times, now_ms) {
  const when = (/** @type {string} */ at) => dayAndTime(at, now_ms);
  const spans = times.map(
    ({ from, to, from_ratio, to_ratio }) => html`<li>${t("robots.battery.charge", {
      from: when(from),
      to: when(to),
      from_ratio: percent(from_ratio),
      to_ratio: percent(to_ratio),
    })}</li>`,
  );
  return html`${spans.length ? html`<ul class="charges">${spans}</ul>` : nothing}
    <table>
      <thead><tr><th scope="col">${t("robots.battery.time")}</th><th scope="col">${t("robots.battery.ratio")}</th></tr></thead>
      <tbody>${some(samples, ROWS).map(({ at, ratio }) => html`<tr><td>${when(at)}</td><td>${percent(ratio)}</td></tr>`)}</tbody>
    </table>`;
}

customElements.define("robot-battery", RobotBattery);
