/** A button that asks once before it does what it says; what came of it is told in a `done` event. */
import { html, nothing } from "lit";
import { inWords } from "../service/problems.js";
import { problemLine } from "./field.js";
import { PageElement } from "./page_element.js";

/** @typedef {{open: string, title: string, body: string, yes: string, no: string}} Words */

export class AskFirst extends PageElement {
  static properties = {
    words: { attribute: false },
    label: { attribute: false },
    act: { attribute: false },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {Words} */
    this.words = { open: "", title: "", body: "", yes: "", no: "" };
    /** The button's accessible name where there are several of its kind. */
    this.label = "";
    /** @type {() => Promise<unknown>} */
    this.act = async () => undefined;
    this.problem = "";
  }

  render() {
    const { open, title, body, yes, no } = this.words;
    return html`<button type="button" class="quiet danger" aria-label=${this.label || nothing} @click=${() => this.#dialog.showModal()}>${open}</button>
      ${this.problem ? problemLine(this.problem) : nothing}
      <dialog aria-label=${title}>
        <h2>${title}</h2>
        <p>${body}</p>
        <div class="choices">
          <button type="button" class="main" autofocus @click=${() => this.#dialog.close()}>${no}</button>
          <button type="button" class="quiet danger" @click=${this.#do}>${yes}</button>
        </div>
      </dialog>`;
  }

  get #dialog() {
    return /** @type {HTMLDialogElement} */ (this.querySelector("dialog"));
  }

  async #do() {
    this.#dialog.close();
    this.problem = "";
    try {
      this.dispatchEvent(new CustomEvent("done", { detail: await this.act() }));
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("ask-first", AskFirst);
