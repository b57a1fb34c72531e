/** Cancelling an order (with the mail aboard: having it brought back), after asking once. Tells the order as it is then in a `changed` event. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { inWords } from "../problems.js";
import { t } from "../texts.js";
import { problemLine } from "./field.js";
import { PageElement } from "./page_element.js";

export class CancelOrder extends PageElement {
  static properties = { order_id: { attribute: false }, aboard: { type: Boolean }, problem: { state: true } };

  constructor() {
    super();
    this.order_id = "";
    /** Whether the robot carries the mail already. */
    this.aboard = false;
    this.problem = "";
  }

  render() {
    const words = this.aboard ? bringBackWords : cancelWords;
    return html`<button class="quiet danger" @click=${() => this.#dialog.showModal()}>${words("open")}</button>
      ${this.problem ? problemLine(this.problem) : nothing}
      <dialog aria-labelledby="cancel-title">
        <h2 id="cancel-title">${words("title")}</h2>
        <p>${words("body")}</p>
        <div class="choices">
          <button class="main" autofocus @click=${() => this.#dialog.close()}>${words("no")}</button>
          <button class="quiet danger" @click=${this.#cancel}>${words("yes")}</button>
        </div>
      </dialog>`;
  }

  get #dialog() {
    return /** @type {HTMLDialogElement} */ (this.querySelector("dialog"));
  }

  async #cancel() {
    this.#dialog.close();
    this.problem = "";
    try {
      this.dispatchEvent(new CustomEvent("changed", { detail: await api.cancelOrder(this.order_id) }));
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {string} part */
const cancelWords = (part) => t(`cancel.${part}`);

/** @param {string} part */
const bringBackWords = (part) => t(`bring_back.${part}`);

customElements.define("cancel-order", CancelOrder);
