/**
 * Suggestions below a field while its user types: with the field, a combobox as the ARIA Authoring Practices
 * have it. Arrows go round and round, Enter takes, Escape closes; the field keeps the focus, with a finger too.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 */
import { html, nothing } from "lit";
import { address } from "./address.js";
import { counted } from "../texts/texts.js";

/** @template T @implements {ReactiveController} */
export class Offers {
  /** @type {T[]} */
  found = [];
  /** Which of them the arrows have come to. */
  active = -1;
  open = false;

  /** @param {ReactiveControllerHost & HTMLElement} host @param {string} count the text that says how many there are
   *  @param {(chosen: T) => void} choose @param {() => void} [look] when the arrows find nothing to go through */
  constructor(host, count, choose, look = () => {}) {
    this.host = host;
    this.count = count;
    this.choose = choose;
    this.look = look;
    host.addController(this);
  }

  hostUpdated() {
    this.host.querySelector('[role=option][aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }

  /** @param {T[]} found */
  show(found) {
    this.#set(found, -1, found.length > 0);
  }

  close() {
    this.#set(this.found, -1, false);
  }

  /** Tell if the list has used the key: nothing else may then use it. @param {KeyboardEvent} event @returns {boolean} */
  key(event) {
    const by = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (by) this.#go(by);
    else if (event.key === "Enter" && this.open && this.active >= 0) this.#take(this.found[this.active]);
    else if (event.key === "Escape" && this.open) this.close();
    else return false;
    event.preventDefault();
    return true;
  }

  /** The option that the arrows have come to. @param {string} list its id */
  activeIn(list) {
    return this.open && this.active >= 0 ? `${list}-${this.active}` : null;
  }

  /** @param {string} list its id @param {string} label @param {(one: T) => {name: unknown, email: string}} words @param {string} [kind] */
  draw(list, label, words, kind = "") {
    return html`<ul id=${list} role="listbox" class=${kind} aria-label=${label} ?hidden=${!this.open}>
        ${this.found.map((one, i) => this.#option(`${list}-${i}`, one, i === this.active, words(one)))}
      </ul>
      <span class="unseen" role="status">${this.open ? counted(this.count, this.found.length) : nothing}</span>`;
  }

  /** @param {string} id @param {T} one @param {boolean} isActive @param {{name: unknown, email: string}} words */
  #option(id, one, isActive, { name, email }) {
    return html`<li id=${id} role="option" aria-selected=${isActive ? "true" : "false"}
      @pointerdown=${(/** @type {Event} */ event) => event.preventDefault()} @click=${() => this.#take(one)}>
      <strong><bdi>${name}</bdi></strong>${address(email)}
    </li>`;
  }

  /** @param {number} by */
  #go(by) {
    const number = this.found.length;
    if (!number) return this.look();
    const next = this.active + by;
    this.#set(this.found, next < 0 ? number - 1 : next % number, true);
  }

  /** @param {T} one */
  #take(one) {
    this.close();
    this.choose(one);
  }

  /** @param {T[]} found @param {number} active @param {boolean} open */
  #set(found, active, open) {
    Object.assign(this, { found, active, open });
    this.host.requestUpdate();
  }
}
