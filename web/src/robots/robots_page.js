/** The robots: all of them as a list, or one of them in full. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import * as api from "../service/api.js";
import { robotPage } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { batteryText, robotWhy } from "../orders/order_words.js";
import { loadMap, titleOf } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { counted, t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { ago } from "../texts/times.js";
import "./estimate_quality.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Alarm, CampusMap, Robot } from "../../types/api_types.ts" */

const POLL_MS = 30_000;

export class RobotsPage extends PageElement {
  static properties = { robots: { state: true }, alarms: { state: true }, map: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {Robot[] | null} */
    this.robots = null;
    /** @type {Alarm[]} */
    this.alarms = [];
    /** @type {CampusMap | null} */
    this.map = null;
    this.problem = "";
    this.fetched_ms = -POLL_MS;
    new Ticking(this, 5_000);
    new OnLive(this, { robot: (robot) => this.#update(robot), resync: () => this.#fetch() });
  }

  render() {
    return html`<h1>${t("robots.title")}</h1>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${this.robots && this.map ? this.#list(this.robots, this.map) : this.problem ? nothing : html`<p class="waiting" role="status">${t("app.loading")}</p>`}`;
  }

  /** @param {Robot[]} robots @param {CampusMap} map */
  #list(robots, map) {
    if (!robots.length) return html`<p class="empty">${t("robots.none")}</p>`;
    return html`<ul class="robots">
        ${repeat(robots, ({ name }) => name, (robot) => robotCard(robot, this.alarms, map))}
      </ul>
      <estimate-quality .map=${map}></estimate-quality>`;
  }

  /** Alarms have no event of their own: they are looked at again every so often. */
  updated() {
    if (performance.now() > this.fetched_ms + POLL_MS) this.#fetch();
  }

  /** @param {Robot} robot */
  #update(robot) {
    const robots = /** @type {Robot[]} */ (this.robots ?? []);
    const known = robots.some(({ name }) => name === robot.name);
    this.robots = known ? robots.map((one) => (one.name === robot.name ? robot : one)) : [...robots, robot];
  }

  async #fetch() {
    this.fetched_ms = performance.now();
    try {
      const [map, robots, alarms] = await Promise.all([loadMap(), api.robots(), api.openAlarms()]);
      [this.map, this.robots, this.alarms, this.problem] = [map, robots, alarms.items, ""];
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Robot} robot @param {Alarm[]} alarms @param {CampusMap} map */
function robotCard(robot, alarms, map) {
  const { name, last_seen, why } = robot;
  const ringing = alarms.filter((alarm) => alarm.robot === name).length;
  return html`<li>
    <a href=${robotPage(name)}>
      <strong>${t("robot.name", { name })}</strong>
      ${robotState(robot)}
      <span class="doing">${why ? robotWhy(robot, map) : nothing}</span>
      <span class="hint">${
        last_seen ? t("map.seen", { post: titleOf(map, last_seen.post), ago: ago(last_seen.at, serverNow()) }) : t("map.never_seen")
      }</span>
      <span class="signs">
        ${robotCharge(robot)}
        ${ringing ? html`<span class="ringing">${icon("warning")}<span>${counted("robots.alarms", ringing)}</span></span>` : nothing}
      </span>
    </a>
  </li>`;
}

/** The activity of a robot, in one word. @param {Robot} robot */
export function robotState({ activity, online, heard_at }) {
  if (!heard_at) return html`<span class="badge over">${t("robots.never_heard")}</span>`;
  if (!online) return html`<span class="badge away">${t("robots.no_network")}</span>`;
  return html`<span class="badge ${activity}">${t(`mailroom.activity.${activity}`)}</span>`;
}

/** @param {Robot} robot */
export function robotCharge({ battery }) {
  if (!battery) return nothing;
  const words = batteryText(battery);
  return html`<span>${icon("battery")}<span>${words}</span></span>`;
}

customElements.define("robots-page", RobotsPage);
