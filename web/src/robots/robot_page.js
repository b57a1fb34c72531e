/** One robot in full: what it does, its charge over time, what went wrong; for maintainers its senses, mind and keys. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { PAGES } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { robotWhy } from "../orders/order_words.js";
import { loadMap, titleOf } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { ago, dayAndTime } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
import "./robot_battery.js";
import "./robot_commands.js";
import "./robot_faults.js";
import { robotCharge, robotState } from "./robots_page.js";
/** @import { CampusMap, Person, Robot, RobotDetails } from "../../types/api_types.ts" */

const CLOCK_NOISE_S = 2;

export class RobotPage extends PageElement {
  static properties = {
    robot: { attribute: false },
    person: { attribute: false },
    details: { state: true },
    map: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    this.robot = "";
    /** @type {Person | null} */
    this.person = null;
    /** @type {RobotDetails | null} */
    this.details = null;
    /** @type {CampusMap | null} */
    this.map = null;
    this.problem = "";
    new Ticking(this, 5_000);
    new OnLive(this, { robot: (robot) => this.#update(robot), resync: () => this.#fetch() });
  }

  firstUpdated() {
    this.#fetch();
    if (this.isMaintainer) import("./robot_diagnostics.js");
    if (this.isMaintainer) import("./robot_keys.js");
  }

  get isMaintainer() {
    return this.person?.roles.includes("maintainer") ?? false;
  }

  get isDispatcher() {
    return this.person?.roles.includes("dispatcher") ?? false;
  }

  render() {
    const { details, map, robot } = this;
    return html`<p><a class="back" href=${PAGES.robots}>${icon("arrow")}${t("robots.all")}</a></p>
      <h1>${t("robot.name", { name: robot })}</h1>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${details && map ? this.#parts(details, map) : this.problem ? nothing : html`<p class="waiting" role="status">${t("app.loading")}</p>`}`;
  }

  /** @param {RobotDetails} details @param {CampusMap} map */
  #parts(details, map) {
    return html`<div class="robot-parts">
      <section class="card of-now" aria-labelledby="now-title">
        <h2 id="now-title">${t("robots.now")}</h2>
        ${now(details.robot, map)}
        <robot-commands .robot=${details.robot} .map=${map} .may=${this.isDispatcher}></robot-commands>
      </section>
      <robot-battery class="card" .robot=${this.robot}></robot-battery>
      <section class="card about" aria-labelledby="about-title">
        <h2 id="about-title">${t("robots.about")}</h2>
        ${about(details)}
      </section>
      ${this.isMaintainer
        ? html`<robot-diagnostics .robot=${this.robot} .online=${details.robot.online}></robot-diagnostics>`
        : html`<section class="card"><h2>${t("mind.title")}</h2><p class="hint">${t("mind.maintainers")}</p></section>`}
      <robot-faults class="card" .robot=${this.robot} .map=${map}></robot-faults>
      ${this.isMaintainer ? html`<robot-keys class="card" .robot=${this.robot}></robot-keys>` : nothing}
    </div>`;
  }

  /** @param {Robot} robot */
  #update(robot) {
    if (robot.name === this.robot && this.details) this.details = { ...this.details, robot };
  }

  async #fetch() {
    try {
      [this.map, this.details] = await Promise.all([loadMap(), api.robot(this.robot)]);
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Robot} robot @param {CampusMap} map */
function now(robot, map) {
  const { why, last_seen, heard_at, online } = robot;
  const now_ms = serverNow();
  return html`<div class="now">
    <p class="signs">${robotState(robot)} ${robotCharge(robot)}</p>
    ${why ? html`<p class="doing">${robotWhy(robot, map)}</p>` : nothing}
    <p class="hint">${
      last_seen ? t("map.seen", { post: titleOf(map, last_seen.post), ago: ago(last_seen.at, now_ms) }) : t("map.never_seen")
    }</p>
    ${online || !heard_at ? nothing : html`<p class="hint">${t("robot.offline", { ago: ago(heard_at, now_ms) })}</p>`}
  </div>`;
}

/** @param {RobotDetails} details */
function about({ software, map_version, clock_off_s, signs_receipts, takes_taps, enrolled_at }) {
  const off = Math.abs(clock_off_s) < CLOCK_NOISE_S ? t("robots.clock_right") : t("robots.clock_off", { seconds: clock_off_s.toFixed(0) });
  const rows = [
    ["software", software ?? t("robots.not_said")],
    ["map", map_version ?? t("robots.not_said")],
    ["clock", off],
    ["receipts", t(signs_receipts ? "robots.signed" : "robots.unsigned")],
    ["taps", t(takes_taps ? "robots.taps_yes" : "robots.taps_no")],
    ["enrolled", dayAndTime(enrolled_at, serverNow())],
  ];
  return html`<dl class="facts-list">${rows.map(([name, value]) => html`<div><dt>${t(`robots.about.${name}`)}</dt><dd>${value}</dd></div>`)}</dl>`;
}

customElements.define("robot-page", RobotPage);
