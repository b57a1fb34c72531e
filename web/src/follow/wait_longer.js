/** The robot is asked to wait for me a little longer; it says until when. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { clockTime } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Order } from "../../types/api_types.ts" */

const MINUTES = [2, 5];

export class WaitLonger extends PageElement {
  static properties = { order: { attribute: false }, problem: { state: true }, busy: { state: true } };

  constructor() {
    super();
    /** @type {Order | null} */
    this.order = null;
    this.problem = "";
    this.busy = false;
  }

  render() {
    const until = this.order?.wait_until;
    if (!until) return nothing;
    return html`<section class="card wait" aria-labelledby="wait-title">
      <h2 id="wait-title">${t("follow.wait.title")}</h2>
      <p role="status">${t("follow.wait.until", { time: clockTime(until) })}</p>
      <div class="choices">
        ${MINUTES.map(
          (minutes) => html`<button ?disabled=${this.busy} @click=${() => this.#extend(minutes)}>${t("follow.wait.more", { minutes })}</button>`,
        )}
      </div>
      ${this.problem ? problemLine(this.problem) : nothing}
    </section>`;
  }

  /** @param {number} minutes */
  async #extend(minutes) {
    if (!this.order) return;
    [this.busy, this.problem] = [true, ""];
    try {
      const detail = await api.extendWait(this.order.id, minutes * 60);
      this.dispatchEvent(new CustomEvent("changed", { detail, bubbles: true }));
    } catch (failure) {
      this.problem = inWords(failure);
    } finally {
      this.busy = false;
    }
  }
}

customElements.define("wait-longer", WaitLonger);
