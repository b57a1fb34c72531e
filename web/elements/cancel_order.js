/** Cancelling an order, after asking once. Tells the order as it is then in a `changed` event. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { inWords } from "../problems.js";
import { t } from "../texts.js";
import { problemLine } from "./field.js";
import { PageElement } from "./page_element.js";

export class CancelOrder extends PageElement {
  static properties = { order_id: { attribute: false }, problem: { state: true } };

  constructor() {
    super();
    this.order_id = "";
    this.problem = "";
  }

  render() {
    return html`<button class="quiet danger" @click=${() => this.#dialog.showModal()}>${t("cancel.open")}</button>
      ${this.problem ? problemLine(this.problem) : nothing}
      <dialog aria-labelledby="cancel-title">
        <h2 id="cancel-title">${t("cancel.title")}</h2>
        <p>${t("cancel.body")}</p>
        <div class="choices">
          <button class="main" autofocus @click=${() => this.#dialog.close()}>${t("cancel.no")}</button>
          <button class="quiet danger" @click=${this.#cancel}>${t("cancel.yes")}</button>
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

customElements.define("cancel-order", CancelOrder);
