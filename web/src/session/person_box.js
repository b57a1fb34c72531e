/**
 * A person of the campus, searched by part of a name or address while one types. The input may also be the whole address
 * of an unknown person. Dispatches `chosen` with the address.
 */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { Offers } from "../elements/offers.js";
import { t } from "../texts/texts.js";
import { field } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Person } from "../../types/api_types.ts" */

const TYPING_MS = 200;
const SHORTEST = 2;
const AT_ONCE = 6;

export class PersonBox extends PageElement {
  #timer = 0;

  static properties = { name: {}, label: {}, problem: {}, typed: { state: true } };

  constructor() {
    super();
    /** Of the field. */
    this.name = "";
    this.label = "";
    this.problem = "";
    this.typed = "";
    /** @type {Offers<Person>} */
    this.offers = new Offers(this, "mailroom.people", ({ email }) => this.#choose(email));
  }

  clear() {
    this.typed = "";
    this.offers.show([]);
  }

  render() {
    const list = `${this.name}-people`;
    return html`${field(
      { name: this.name, label: this.label, hint: t("mailroom.person_hint"), problem: this.problem },
      ({ id, describedBy, invalid }) => html`<input id=${id} name=${this.name} role="combobox" aria-autocomplete="list"
        aria-expanded=${this.offers.open ? "true" : "false"} aria-controls=${list} aria-activedescendant=${this.offers.activeIn(list) ?? nothing}
        autocomplete="off" autocapitalize="off" spellcheck="false" aria-describedby=${describedBy} aria-invalid=${invalid} .value=${this.typed}
        @input=${this.#type} @keydown=${this.#key} @blur=${() => this.offers.close()} />`,
    )}
    ${this.offers.draw(list, this.label, (person) => person, "people")}`;
  }

  /** @param {InputEvent} event */
  #type(event) {
    event.stopPropagation();
    this.typed = /** @type {HTMLInputElement} */ (event.target).value;
    this.#tell(this.typed.trim());
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#look(this.typed.trim()), TYPING_MS);
  }

  /** @param {string} search */
  async #look(search) {
    const found = search.length < SHORTEST ? [] : (await api.people(search, AT_ONCE).catch(() => ({ items: [] }))).items;
    if (search === this.typed.trim()) this.offers.show(found);
  }

  /** Escape closes the list, not the dialog that it stands in. @param {KeyboardEvent} event */
  #key(event) {
    if (this.offers.key(event)) event.stopPropagation();
  }

  /** @param {string} email */
  #choose(email) {
    this.typed = email;
    this.#tell(email);
  }

  /** @param {string} email */
  #tell(email) {
    this.dispatchEvent(new CustomEvent("chosen", { detail: email }));
  }
}

customElements.define("person-box", PersonBox);
