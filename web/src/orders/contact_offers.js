/**
 * Whom I know, offered below a field while I type in it. It stands right behind its field, and is fetched when a person
 * first comes there. Tells `chosen` with the contact.
 */
import * as api from "../service/api.js";
import { Offers } from "../elements/offers.js";
import { t } from "../texts/texts.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Contact } from "../../types/api_types.ts" */

const TYPING_MS = 150;
const AT_ONCE = 6;
/** The id of the list that the field controls. */
const LIST = "contact-offers";

export class ContactOffers extends PageElement {
  #timer = 0;
  #leaving = new AbortController();

  /** @type {Offers<Contact>} */
  #offers = new Offers(this, "order.offered", (contact) => this.#choose(contact), () => void this.#look());

  get #field() {
    return /** @type {HTMLInputElement} */ (this.previousElementSibling);
  }

  connectedCallback() {
    super.connectedCallback();
    const { signal } = (this.#leaving = new AbortController());
    this.#field.addEventListener("input", () => this.#soon(), { signal });
    this.#field.addEventListener("focus", () => this.#look(), { signal });
    this.#field.addEventListener("keydown", (event) => this.#offers.key(event), { signal });
    this.#field.addEventListener("blur", () => this.#close(), { signal });
    if (document.activeElement === this.#field) this.#look();
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#leaving.abort();
    clearTimeout(this.#timer);
  }

  render() {
    return this.#offers.draw(LIST, t("order.known"), ({ label, name, email }) => ({ name: label || name || email, email }));
  }

  updated() {
    const at = this.#offers.activeIn(LIST);
    this.#field.setAttribute("aria-expanded", `${this.#offers.open}`);
    if (at) this.#field.setAttribute("aria-activedescendant", at);
    else this.#field.removeAttribute("aria-activedescendant");
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
    this.#offers.show(items.filter(({ email }) => email !== search));
  }

  #close() {
    clearTimeout(this.#timer);
    this.#offers.close();
  }

  /** @param {Contact} contact */
  #choose(contact) {
    clearTimeout(this.#timer);
    this.dispatchEvent(new CustomEvent("chosen", { detail: contact }));
  }
}

customElements.define("contact-offers", ContactOffers);
