/**
 * A tree as the ARIA Authoring Practices have it: one tab stop, arrows up and down go through what is seen, left and
 * right close and open, and lead out and in. What is open, and where the keyboard stands, is kept in the tree's own
 * elements: they stay as they are when it is drawn again.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 */

const ITEM = "[role=treeitem]";

/** @implements {ReactiveController} */
export class TreeKeys {
  /** @param {ReactiveControllerHost & HTMLElement} host within which the tree is drawn */
  constructor(host) {
    this.host = host;
    host.addController(this);
    host.addEventListener("keydown", (event) => this.#key(event));
    host.addEventListener("click", (event) => this.#press(event));
    host.addEventListener("focusin", (event) => isItem(event.target) && this.#stopAt(event.target));
  }

  /** The item of the tab stop may be gone, or within what was closed. */
  hostUpdated() {
    const seen = this.#seen();
    this.#stopAt(seen.find((item) => item.tabIndex === 0) ?? seen[0]);
  }

  /** @returns {HTMLElement[]} */
  #items() {
    return [...this.host.querySelectorAll(ITEM)].filter(isItem);
  }

  #seen() {
    return this.#items().filter((item) => !item.parentElement?.closest('[aria-expanded="false"]'));
  }

  /** @param {HTMLElement | undefined} chosen */
  #stopAt(chosen) {
    for (const item of this.#items()) item.tabIndex = item === chosen ? 0 : -1;
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const { target: item, ctrlKey, altKey, metaKey } = event;
    const act = !ctrlKey && !altKey && !metaKey && isItem(item) ? this.#acts(item)[event.key] : undefined;
    if (!act) return;
    event.preventDefault();
    act();
  }

  /** @param {HTMLElement} item @returns {Record<string, () => void>} */
  #acts(item) {
    const seen = this.#seen();
    const at = seen.indexOf(item);
    const isOpen = item.getAttribute("aria-expanded");
    return {
      ArrowDown: () => seen[at + 1]?.focus(),
      ArrowUp: () => seen[at - 1]?.focus(),
      Home: () => seen[0].focus(),
      End: () => seen[seen.length - 1].focus(),
      ArrowRight: () => (isOpen === "true" ? within(item)?.focus() : this.#turn(item)),
      ArrowLeft: () => (isOpen === "true" ? this.#turn(item) : around(item)?.focus()),
      Enter: () => this.#turn(item),
      " ": () => this.#turn(item),
    };
  }

  /** With a finger: its own line, not the room of what it holds. @param {MouseEvent} event */
  #press(event) {
    const line = event.target instanceof Element ? event.target.closest(".line") : null;
    const item = line?.parentElement;
    if (!isItem(item)) return;
    item.focus();
    this.#turn(item);
  }

  /** @param {HTMLElement} item */
  #turn(item) {
    const isOpen = item.getAttribute("aria-expanded");
    if (isOpen) item.setAttribute("aria-expanded", isOpen === "true" ? "false" : "true");
  }
}

/** @param {unknown} node @returns {node is HTMLElement} */
const isItem = (node) => node instanceof HTMLElement && node.matches(ITEM);

/** @param {HTMLElement} item */
const within = (item) => /** @type {HTMLElement | null} */ (item.querySelector(ITEM));

/** @param {HTMLElement} item */
const around = (item) => /** @type {HTMLElement | null | undefined} */ (item.parentElement?.closest(ITEM));
