/** When a letter is to be fetched: not before a moment, or again and again. Tells `scheduled` with what was chosen. */
import { html, nothing } from "lit";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { weekdayName } from "../texts/times.js";
import { field, problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";

/** @typedef {"now" | "later" | "again"} When */
/** @typedef {{not_before?: string, weekdays?: number[], at?: string, zone?: string, until?: string | null}} Schedule */

const MINUTE_MS = 60_000;
const HALF_AN_HOUR_MS = 30 * MINUTE_MS;
const WEEK = [0, 1, 2, 3, 4, 5, 6];

export class OrderSchedule extends PageElement {
  static properties = { kind: { attribute: false }, schedule: { attribute: false }, problem: { attribute: false } };

  constructor() {
    super();
    /** @type {"later" | "again"} */
    this.kind = "later";
    /** @type {Schedule} */
    this.schedule = {};
    this.problem = "";
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("kind")) this.#tell(this.kind === "later" ? laterOf(this.schedule) : againOf(this.schedule));
  }

  render() {
    return html`<div class="schedule" @input=${(/** @type {Event} */ event) => event.stopPropagation()}>
      ${this.kind === "later" ? this.#later() : this.#again()} ${this.problem ? problemLine(this.problem) : nothing}
    </div>`;
  }

  #later() {
    const { not_before } = this.schedule;
    return field(
      { name: "not_before", label: t("order.not_before"), hint: t("order.not_before_hint") },
      ({ id, describedBy }) => html`<input id=${id} type="datetime-local" required .value=${not_before ? localText(Date.parse(not_before)) : ""}
        min=${localText(serverNow())} aria-describedby=${describedBy}
        @change=${(/** @type {Event} */ event) => this.#tell({ not_before: momentOf(valueOf(event)) })} />`,
    );
  }

  #again() {
    const { weekdays = [], at, until } = this.schedule;
    return html`<fieldset class="pills days">
        <legend>${t("order.weekdays")}</legend>
        ${WEEK.map(
          (day) => html`<label class="pill"><input type="checkbox" aria-label=${weekdayName(day)} .checked=${weekdays.includes(day)}
            @change=${() => this.#toggle(day)} /><span aria-hidden="true">${weekdayName(day, "short")}</span></label>`,
        )}
      </fieldset>
      <div class="pair">
        ${field({ name: "at", label: t("order.at") }, ({ id }) => html`<input id=${id} type="time" required .value=${at ?? ""}
          @change=${(/** @type {Event} */ event) => this.#tell({ ...this.schedule, at: valueOf(event) })} />`)}
        ${field({ name: "until", label: t("order.until"), optional: true }, ({ id }) => html`<input id=${id} type="date" .value=${until ?? ""}
          @change=${(/** @type {Event} */ event) => this.#tell({ ...this.schedule, until: valueOf(event) || null })} />`)}
      </div>`;
  }

  /** @param {number} day */
  #toggle(day) {
    const before = this.schedule.weekdays ?? [];
    const weekdays = before.includes(day) ? before.filter((one) => one !== day) : [...before, day].sort();
    this.#tell({ ...this.schedule, weekdays });
  }

  /** @param {Schedule} schedule */
  #tell(schedule) {
    this.schedule = schedule;
    this.dispatchEvent(new CustomEvent("scheduled", { detail: schedule }));
  }
}

/** @param {Event} event */
const valueOf = ({ target }) => /** @type {HTMLInputElement} */ (target).value;

/** The next half hour but one, until another is chosen. @param {Schedule} schedule @returns {Schedule} */
const laterOf = ({ not_before }) => ({
  not_before: not_before ?? new Date(Math.ceil(serverNow() / HALF_AN_HOUR_MS + 1) * HALF_AN_HOUR_MS).toISOString(),
});

/** Each week at this day and half hour, until something else is chosen. @param {Schedule} schedule @returns {Schedule} */
function againOf({ weekdays, at, until }) {
  const now = new Date(Math.ceil(serverNow() / HALF_AN_HOUR_MS) * HALF_AN_HOUR_MS);
  return {
    weekdays: weekdays ?? [(now.getDay() + 6) % 7],
    at: at ?? localText(now.getTime()).slice(-5),
    zone: Intl.DateTimeFormat().resolvedOptions().timeZone,
    until: until ?? null,
  };
}

/** As a field has it: local, "2026-01-05T09:30". @param {number} at_ms */
const localText = (at_ms) =>
  new Date(at_ms - new Date(at_ms).getTimezoneOffset() * MINUTE_MS).toISOString().slice(0, 16);

/** @param {string} local */
const momentOf = (local) => (local ? new Date(local).toISOString() : undefined);

customElements.define("order-schedule", OrderSchedule);
