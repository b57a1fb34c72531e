/** Six digits instead of the camera: typed by any party to the letter, they open for the one whose digits they are. */
import { html, nothing } from "lit";
import { inWords } from "../service/problems.js";
import { robotAsked } from "./shows_outcome.js";
import { t } from "../texts/texts.js";
import { field } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Door } from "./handover_code.js" */

const DIGITS = 6;

export class DigitsEntry extends PageElement {
  static properties = { door: { attribute: false }, problem: { state: true }, said: { state: true }, busy: { state: true } };

  constructor() {
    super();
    /** @type {Door | null} */
    this.door = null;
    this.problem = "";
    this.said = "";
    this.busy = false;
  }

  render() {
    return html`<form novalidate @submit=${this.#send}>
      ${field(
        { name: "digits", label: t("follow.digits.label"), hint: t("follow.digits.hint"), problem: this.problem },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="digits" class="digits" inputmode="numeric" autocomplete="off"
          maxlength="9" aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      <button ?disabled=${this.busy}>${t("follow.digits.send")}</button>
      <p role="status">${this.said || nothing}</p>
    </form>`;
  }

  /** @param {SubmitEvent} event */
  async #send(event) {
    event.preventDefault();
    const input = /** @type {HTMLInputElement} */ (this.querySelector("[name=digits]"));
    const digits = input.value.replace(/\D/g, "");
    [this.said, this.problem] = ["", digits.length === DIGITS ? "" : t("follow.digits.missing")];
    if (this.problem || this.busy || !this.door) return this.focusOn("[aria-invalid]");
    this.busy = true;
    this.dispatchEvent(robotAsked());
    try {
      await this.door.handOver(digits);
      input.value = "";
      this.said = t("code.asked");
    } catch (failure) {
      this.problem = inWords(failure);
      this.focusOn("[aria-invalid]");
    } finally {
      this.busy = false;
    }
  }
}

customElements.define("digits-entry", DigitsEntry);
