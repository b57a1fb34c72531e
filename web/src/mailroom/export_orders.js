/** A table of the orders of some days, for a spreadsheet. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { field } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";

const DAY_MS = 86_400_000;
const USUAL_DAYS = 30;

export class ExportOrders extends PageElement {
  static properties = { first: { state: true }, last: { state: true } };

  constructor() {
    super();
    /** Days here, both included, such as 2026-01-05. */
    this.first = "";
    this.last = "";
  }

  async open() {
    [this.first, this.last] = [dayOf(serverNow() - USUAL_DAYS * DAY_MS), dayOf(serverNow())];
    await this.updateComplete;
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).showModal();
    this.focusOn("[name=first]");
  }

  render() {
    const fits = Boolean(this.first && this.last) && this.first <= this.last;
    return html`<dialog class="ask" aria-labelledby="export-title">
      <form @submit=${this.#submit}>
        <div>
          <h2 id="export-title">${t("mailroom.export")}</h2>
          <p>${t("mailroom.export.hint")}</p>
        </div>
        <div class="pair">${this.#day("first")} ${this.#day("last", fits ? "" : t("mailroom.export.backwards"))}</div>
        <div class="choices">
          <button class="main">${t("mailroom.export.yes")}</button>
          <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.not_now")}</button>
        </div>
      </form>
    </dialog>`;
  }

  /** @param {"first" | "last"} name @param {string} [problem] */
  #day(name, problem = "") {
    return field({ name, label: t(`mailroom.export.${name}`), problem: problem && this.first ? problem : undefined }, ({ id, describedBy, invalid }) =>
      html`<input id=${id} name=${name} type="date" required .value=${this[name]} aria-describedby=${describedBy ?? nothing} aria-invalid=${invalid}
        @input=${(/** @type {InputEvent} */ event) => (this[name] = /** @type {HTMLInputElement} */ (event.target).value)} />`);
  }

  /** The answer is a file: the page stays. @param {SubmitEvent} event */
  #submit(event) {
    event.preventDefault();
    if (!this.first || !this.last || this.first > this.last) return void this.focusOn("[aria-invalid], [name=first]");
    const link = document.createElement("a");
    link.href = api.ordersTable(midnight(this.first).toISOString(), midnight(this.last, 1).toISOString());
    link.download = "";
    link.click();
    this.#close();
  }

  #close() {
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).close();
  }
}

/** The day here, as a date field has it. @param {number} at_ms */
function dayOf(at_ms) {
  const at = new Date(at_ms);
  return [at.getFullYear(), at.getMonth() + 1, at.getDate()].map((part) => `${part}`.padStart(2, "0")).join("-");
}

/** The beginning of a day here. @param {string} day @param {number} [later] so many days after it */
function midnight(day, later = 0) {
  const [year, month, date] = day.split("-").map(Number);
  return new Date(year, month - 1, date + later);
}

customElements.define("export-orders", ExportOrders);
