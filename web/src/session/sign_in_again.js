/** Over a page whose session has ended: sign in again, and go on with what is typed there. */
import { html, nothing } from "lit";
import { putAway, signedIn } from "./session_lost.js";
import { t } from "../texts/texts.js";
import { PageElement } from "../elements/page_element.js";
import "./sign_in.js";
/** @import { About, Person } from "../../types/api_types.ts" */

export class SignInAgain extends PageElement {
  static properties = { about: { attribute: false }, email: { attribute: false }, isAsking: { state: true } };
  #isDone = false;

  constructor() {
    super();
    /** @type {About | null} */
    this.about = null;
    /** Of the person who was signed in. */
    this.email = "";
    this.isAsking = false;
  }

  /** Clear the last input only now: a dialog that loses its inside while it closes takes the place of the
   *  next letter with it, and the field that has the focus again gets none. */
  async open() {
    await this.updateComplete;
    if (this.#dialog.open) return;
    [this.isAsking, this.#isDone] = [false, false];
    await this.updateComplete;
    this.isAsking = true;
    await this.updateComplete;
    if (this.#isDone || this.#dialog.open) return;
    this.#dialog.showModal();
    this.focusOn("button.main");
  }

  /** The keyboard goes back by itself to where it was. */
  close() {
    this.#isDone = true;
    this.#dialog.close();
  }

  render() {
    return html`<dialog aria-labelledby="again-title" aria-describedby="again-lead" @close=${this.#closed}>
      <h2 id="again-title">${t("sign_in.again")}</h2>
      <p id="again-lead">${t("sign_in.again_lead")}</p>
      ${this.isAsking ? html`<sign-in again .about=${this.about} .email=${this.email} @signed-in=${done}></sign-in>` : nothing}
      <button type="button" class="quiet" @click=${() => this.#dialog.close()}>${t("sign_in.not_now")}</button>
    </dialog>`;
  }

  /** By its person, as with Escape, unless it was closed from outside. */
  #closed() {
    if (!this.#isDone) putAway();
  }

  get #dialog() {
    return /** @type {HTMLDialogElement} */ (this.querySelector("dialog"));
  }
}

/** @param {CustomEvent<Person>} event */
const done = ({ detail }) => signedIn(detail);

customElements.define("sign-in-again", SignInAgain);
