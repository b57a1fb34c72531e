/** Faults and alarms of a robot, newest first, each with its place and times. */
import { html, nothing } from "lit";
import { alarmText } from "../texts/alarm_words.js";
import * as api from "../service/api.js";
import { titleOf } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Alarm, CampusMap, Page } from "../../types/api_types.ts" */

const AT_ONCE = 10;

export class RobotFaults extends PageElement {
  static properties = { robot: { attribute: false }, map: { attribute: false }, faults: { state: true }, problem: { state: true } };

  constructor() {
    super();
    this.robot = "";
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Page<Alarm> | null} */
    this.faults = null;
    this.problem = "";
  }

  firstUpdated() {
    this.#more();
  }

  render() {
    const { faults } = this;
    return html`<section aria-labelledby="faults-title">
      <h2 id="faults-title">${t("robots.faults")}</h2>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${faults && !faults.items.length ? html`<p class="empty">${t("robots.faults.none")}</p>` : nothing}
      <ul class="faults">${faults?.items.map((alarm) => this.#line(alarm))}</ul>
      ${faults?.next ? html`<button class="quiet" @click=${this.#more}>${t("robots.faults.more")}</button>` : nothing}
    </section>`;
  }

  /** @param {Alarm} alarm */
  #line(alarm) {
    const { name, post, at, cleared_at, acknowledged_at } = alarm;
    const now_ms = serverNow();
    const until = cleared_at ? t("robots.faults.until", { time: dayAndTime(cleared_at, now_ms) }) : "";
    const standing = cleared_at ? "over" : acknowledged_at ? "seen_to" : "open";
    return html`<li class=${standing}>
      <span class="badge ${standing}">${t(`robots.fault.${standing}`)}</span>
      <div>
        <p><bdi>${alarmText(alarm, this.map)}</bdi></p>
        <p class="hint">
          <time datetime=${at}>${dayAndTime(at, now_ms)}</time>${until ? ` ${until}` : nothing}${
            post && this.map ? ` · ${titleOf(this.map, post)}` : nothing} · <code>${name}</code>
        </p>
      </div>
    </li>`;
  }

  async #more() {
    try {
      const older = await api.robotAlarms(this.robot, { limit: AT_ONCE, cursor: this.faults?.next ?? undefined });
      this.faults = { items: [...(this.faults?.items ?? []), ...older.items], next: older.next };
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("robot-faults", RobotFaults);
