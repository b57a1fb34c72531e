/** When it would arrive, asked and said before anything is ordered, with how much that is worth. */
import { html } from "lit";
import * as api from "../service/api.js";
import { FIELD_OF_CODE, atFields } from "../service/problems.js";
import { reasonText } from "../texts/reason_words.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { length, windowText } from "../texts/times.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Estimate } from "../../types/api_types.ts" */
/** @import { Schedule, When } from "./order_schedule.js" */
/** Refused fields, as `{field: sentence}`. @typedef {CustomEvent<Record<string, string>>} Refused */

const DAY_MS = 86_400_000;

export class OrderEstimate extends PageElement {
  static properties = {
    from: { attribute: false },
    to: { attribute: false },
    when: { attribute: false },
    schedule: { attribute: false },
    estimate: { state: true },
  };

  constructor() {
    super();
    this.from = "";
    this.to = "";
    /** @type {When} */
    this.when = "now";
    /** @type {Schedule} */
    this.schedule = {};
    /** @type {Estimate | "looking" | null} if it were fetched now */
    this.estimate = null;
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("from") || changed.has("to")) this.#look();
  }

  render() {
    return html`${icon("clock")}<div>${this.#words()}</div>`;
  }

  #words() {
    const { estimate } = this;
    if (estimate === null || estimate === "looking") return html`<span class="hint">${t(estimate ? "estimate.looking" : "estimate.wait")}</span>`;
    if (estimate.reason && this.when === "now") return html`<span class="of">${t("window.none")}</span> <span class="hint">${reasonText(estimate.reason, estimate.reason_words ?? null, null)}</span>`;
    return html`<span class="of">${t("estimate.title")}</span> <strong>${this.#window(estimate)}</strong>
      <span class="hint">${t(estimate.assumed ? "estimate.assumed" : "estimate.based", { length: length(estimate.length_m) })}</span>`;
  }

  /** @param {Estimate} estimate what comes on many days has no day */
  #window({ window }) {
    return windowText(later(window, this.#later_ms()), this.when === "again" ? undefined : serverNow());
  }

  /** By how much the robot comes later than it would now. */
  #later_ms() {
    const { not_before, at } = this.schedule;
    if (this.when === "again" && at) return untilTime(at);
    return this.when === "later" && not_before ? Math.max(0, Date.parse(not_before) - serverNow()) : 0;
  }

  /** Asks each time that the ends of the way change. */
  async #look() {
    const { from, to } = this;
    const stillWanted = () => from === this.from && to === this.to;
    this.estimate = null;
    if (!from || !to) return;
    if (from === to) return this.#refuse({ to_post: t("error.same_post") });
    this.estimate = "looking";
    try {
      const estimate = await api.estimate(from, to);
      if (stillWanted()) this.estimate = estimate;
    } catch (failure) {
      if (!stillWanted()) return;
      this.estimate = null;
      this.#refuse(atFields(failure, FIELD_OF_CODE));
    }
  }

  /** @param {Record<string, string>} problems */
  #refuse(problems) {
    this.dispatchEvent(new CustomEvent("refused", { detail: problems }));
  }
}

/** The time until the next such time of the day. @param {string} at local, "09:30" */
function untilTime(at) {
  const [hour, minute] = at.split(":").map(Number);
  const then = new Date(serverNow());
  return (then.setHours(hour, minute, 0, 0) - serverNow() + DAY_MS) % DAY_MS;
}

/** @param {{from: string, to: string}} window @param {number} by_ms */
const later = ({ from, to }, by_ms) => ({ from: moved(from, by_ms), to: moved(to, by_ms) });

/** @param {string} at @param {number} by_ms */
const moved = (at, by_ms) => new Date(Date.parse(at) + by_ms).toISOString();

customElements.define("order-estimate", OrderEstimate);
