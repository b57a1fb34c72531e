/**
 * Whom I know, offered below a field while I type in it: with the field, a combobox as the ARIA Authoring Practices have
 * it. It stands right behind its field, and is fetched when somebody first comes there. Tells `chosen` with the contact.
 */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { counted, t } from "../texts.js";
import { PageElement } from "./page_element.js";
/** @import { Contact } from "../api_types.ts" */

const TYPING_MS = 150;
const AT_ONCE = 6;

export class ContactOffers extends PageElement {
  #timer = 0;
  #leaving = new AbortController();

  static properties = { found: { state: true }, active: { state: true }, open: { state: true } };

  constructor() {
    super();
    /** @type {Contact[]} */
    this.found = [];
    /** Which of them the arrows have come to. */
    this.active = -1;
    this.open = false;
  }

  get #field() {
    return /** @type {HTMLInputElement} */ (this.previousElementSibling);
  }

  connectedCallback() {
    super.connectedCallback();
    const { signal } = (this.#leaving = new AbortController());
    this.#field.addEventListener("input", () => this.#soon(), { signal });
    this.#field.addEventListener("focus", () => this.#look(), { signal });
    this.#field.addEventListener("keydown", (event) => this.#key(event), { signal });
    this.#field.addEventListener("blur", () => this.#close(), { signal });
    if (document.activeElement === this.#field) this.#look();
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#leaving.abort();
    clearTimeout(this.#timer);
  }

  render() {
    return html`<ul id="contact-offers" role="listbox" aria-label=${t("order.known")} ?hidden=${!this.open}>
        ${this.found.map(
          (one, i) => html`<li id="contact-offer-${i}" role="option" aria-selected=${i === this.active ? "true" : "false"}
            @pointerdown=${(/** @type {Event} */ event) => event.preventDefault()} @click=${() => this.#choose(one)}>
            <strong>${one.label || one.name || one.email}</strong><span class="address">${one.email}</span>
          </li>`,
        )}
      </ul>
      <span class="unseen" role="status">${this.open ? counted("order.offered", this.found.length) : nothing}</span>`;
  }

  updated() {
    const at = this.open && this.active >= 0 ? `contact-offer-${this.active}` : "";
    this.#field.setAttribute("aria-expanded", `${this.open}`);
    if (at) this.#field.setAttribute("aria-activedescendant", at);
    else this.#field.removeAttribute("aria-activedescendant");
    if (at) this.querySelector(`#${at}`)?.scrollIntoView({ block: "nearest" });
  }

  #soon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#look(), TYPING_MS);
  }

  /** A whole address that is the only one found needs no offer. */
  async #look() {
    const search = this.#field.value.trim();
    const { items } = await api.contacts({ search, limit: AT_ONCE }).catch(() => ({ items: [] }));
    if (search !== this.#field.value.trim() || document.activeElement !== this.#field) return;
    const found = items.filter(({ email }) => email !== search);
    [this.found, this.active, this.open] = [found, -1, found.length > 0];
  }

  #close() {
    clearTimeout(this.#timer);
    [this.open, this.active] = [false, -1];
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    if (event.key === "ArrowDown") this.#go(1);
    else if (event.key === "ArrowUp") this.#go(-1);
    else if (event.key === "Enter" && this.open && this.active >= 0) this.#choose(this.found[this.active]);
    else if (event.key === "Escape" && this.open) this.#close();
    else return;
    event.preventDefault();
  }

  /** Round and round. @param {number} by */
  #go(by) {
    const number = this.found.length;
    if (!number) return void this.#look();
    this.active = this.active < 0 && by < 0 ? number - 1 : (this.active + by + number) % number;
    this.open = true;
  }

  /** @param {Contact} contact */
  #choose(contact) {
    this.#close();
    this.dispatchEvent(new CustomEvent("chosen", { detail: contact }));
  }
}

customElements.define("contact-offers", ContactOffers);
