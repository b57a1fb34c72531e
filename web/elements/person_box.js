/**
 * Somebody of the campus, found by part of a name or address: a combobox as the ARIA Authoring Practices have it. What is
 * typed may also be the whole address of somebody who is not known yet. Tells `chosen` with the address.
 */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { counted, t } from "../texts.js";
import { field } from "./field.js";
import { PageElement } from "./page_element.js";
/** @import { Person } from "../api_types.ts" */

const TYPING_MS = 200;
const SHORTEST = 2;
const AT_ONCE = 6;

export class PersonBox extends PageElement {
  #timer = 0;

  static properties = {
    name: {},
    label: {},
    problem: {},
    typed: { state: true },
    found: { state: true },
    active: { state: true },
    open: { state: true },
  };

  constructor() {
    super();
    /** Of the field. */
    this.name = "";
    this.label = "";
    this.problem = "";
    this.typed = "";
    /** @type {Person[]} */
    this.found = [];
    /** Which of them the arrows have come to. */
    this.active = -1;
    this.open = false;
  }

  clear() {
    [this.typed, this.found, this.open] = ["", [], false];
  }

  render() {
    const list = `${this.name}-people`;
    const active = this.open && this.active >= 0 ? `${list}-${this.active}` : nothing;
    return html`${field(
      { name: this.name, label: this.label, hint: t("mailroom.person_hint"), problem: this.problem },
      ({ id, describedBy, invalid }) => html`<input id=${id} name=${this.name} role="combobox" aria-autocomplete="list"
        aria-expanded=${this.open ? "true" : "false"} aria-controls=${list} aria-activedescendant=${active} autocomplete="off"
        autocapitalize="off" spellcheck="false" aria-describedby=${describedBy} aria-invalid=${invalid} .value=${this.typed}
        @input=${this.#type} @keydown=${this.#key} @blur=${this.#leave} />`,
    )}
    <ul id=${list} role="listbox" class="people" aria-label=${this.label} ?hidden=${!this.open}>
      ${this.found.map(
        ({ name, email }, i) => html`<li id="${list}-${i}" role="option" aria-selected=${i === this.active ? "true" : "false"}
          @pointerdown=${(/** @type {Event} */ event) => event.preventDefault()} @click=${() => this.#choose(i)}>
          <strong>${name}</strong><span>${email}</span>
        </li>`,
      )}
    </ul>
    <span class="unseen" role="status">${this.open ? counted("mailroom.people", this.found.length) : nothing}</span>`;
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
    if (search !== this.typed.trim()) return;
    [this.found, this.active, this.open] = [found, -1, found.length > 0];
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const move = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (move && this.found.length) this.#go(move);
    else if (event.key === "Enter" && this.open && this.active >= 0) this.#choose(this.active);
    else if (event.key === "Escape" && this.open) this.open = false;
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** Round and round, from what was typed to the first and the last. @param {number} by */
  #go(by) {
    const next = this.active + by;
    this.active = next < 0 ? this.found.length - 1 : next % this.found.length;
    this.open = true;
  }

  /** @param {number} i */
  #choose(i) {
    const { email } = this.found[i];
    [this.typed, this.open] = [email, false];
    this.#tell(email);
  }

  #leave() {
    this.open = false;
  }

  /** @param {string} email */
  #tell(email) {
    this.dispatchEvent(new CustomEvent("chosen", { detail: email }));
  }
}

customElements.define("person-box", PersonBox);
