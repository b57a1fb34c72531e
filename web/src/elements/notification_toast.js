/**
 * Shows a new notification on any page, for as long as it takes to read and reach: time stands still while
 * the pointer or the keyboard is on it, Escape puts it away, and it never lies over what has the keyboard.
 */
import { html, nothing } from "lit";
import { orderFrom, pageOf } from "../service/links.js";
import { t } from "../texts/texts.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
/** @import { Inbox, NotificationView } from "../../types/api_types.ts" */

const SHOWN_MS = 12_000;
/** The first of these is wanted, and taken where there is room at neither. */
const PLACES = ["toast", "toast high"];

export class NotificationToast extends PageElement {
  static properties = { inbox: { attribute: false }, since: { attribute: false }, notice: { state: true } };

  /** @type {AbortController | null} */
  #listening = null;
  #timer = 0;
  #isPointedAt = false;
  /** Ids of what is told already. @type {Set<number>} */
  #told = new Set();
  /** The element that had the focus before. @type {EventTarget | null} */
  #before = null;

  constructor() {
    super();
    /** @type {Inbox | null} as it is now; its source may have received notifications before this element was there */
    this.inbox = null;
    /** When the page was opened; what was told before is no news. */
    this.since = "";
    /** @type {NotificationView | null} */
    this.notice = null;
  }

  connectedCallback() {
    super.connectedCallback();
    const { signal } = (this.#listening = new AbortController());
    document.addEventListener("keydown", (event) => this.#key(event), { signal });
    document.addEventListener("focusin", () => requestAnimationFrame(() => this.#keepClear()), { signal });
    document.addEventListener("scrollend", () => this.#keepClear(), { signal });
    document.addEventListener("visibilitychange", () => this.#count(), { signal });
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#listening?.abort();
    clearTimeout(this.#timer);
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("inbox")) this.notice = this.#news() ?? this.#stillUnread();
    if (changed.has("notice")) this.#count();
  }

  render() {
    return html`<div role="status">${this.notice ? this.#toast(this.notice) : nothing}</div>`;
  }

  /** @param {NotificationView} notice */
  #toast(notice) {
    return html`<div class="toast" @pointerenter=${() => this.#point(true)} @pointerleave=${() => this.#point(false)}
      @focusin=${this.#takeKeyboard} @focusout=${() => this.#count()}>
      <a href=${pageOf(notice) ?? nothing}><strong><bdi>${notice.title}</bdi></strong><bdi>${notice.body}</bdi></a>
      <button class="quiet" aria-label=${t("notices.dismiss")} @click=${this.#putAway}>${icon("cross")}</button>
    </div>`;
  }

  updated() {
    this.#keepClear();
  }

  /** A person on that letter's own page needs no toast: the page shows the change. */
  #news() {
    const since_ms = Date.parse(this.since);
    const news = this.inbox?.items.filter(({ id, at, read }) => !read && Date.parse(at) > since_ms && !this.#told.has(id)) ?? [];
    news.forEach(({ id }) => this.#told.add(id));
    return news.find(({ order_id }) => order_id === null || order_id !== orderFrom(location.search));
  }

  /** It may have been read elsewhere. */
  #stillUnread() {
    const now = this.inbox?.items.find(({ id }) => id === this.notice?.id);
    return now?.read ? null : this.notice;
  }

  /** Time runs while neither pointer nor focus is on it and the page is visible. */
  #count() {
    clearTimeout(this.#timer);
    this.#isPointedAt &&= this.notice !== null;
    if (!this.notice || this.#isPointedAt || this.contains(document.activeElement) || document.hidden) return;
    this.#timer = setTimeout(() => (this.notice = null), SHOWN_MS);
  }

  /** @param {boolean} isPointedAt */
  #point(isPointedAt) {
    this.#isPointedAt = isPointedAt;
    this.#count();
  }

  /** @param {FocusEvent} event */
  #takeKeyboard({ relatedTarget }) {
    if (!(relatedTarget instanceof Node && this.contains(relatedTarget))) this.#before = relatedTarget;
    this.#count();
  }

  /** Close on Escape, unless a nearer handler has used the key; a dialog closes first. @param {KeyboardEvent} event */
  #key(event) {
    if (event.key !== "Escape" || event.defaultPrevented || document.querySelector("dialog:modal")) return;
    this.#putAway();
  }

  #putAway() {
    const back = this.contains(document.activeElement) ? this.#before : null;
    [this.notice, this.#before] = [null, null];
    if (back instanceof HTMLElement) back.focus();
  }

  #keepClear() {
    const toast = this.querySelector(".toast");
    const here = document.activeElement;
    if (!toast || !here || this.contains(here)) return;
    const keyboard = (here.closest("label") ?? here).getBoundingClientRect();
    const isFree = (/** @type {string} */ place) => {
      toast.className = place;
      return !lieUponEachOther(toast.getBoundingClientRect(), keyboard);
    };
    toast.className = PLACES.find(isFree) ?? PLACES[0];
  }
}

/** @param {DOMRect} one @param {DOMRect} other */
const lieUponEachOther = (one, other) =>
  one.left < other.right && other.left < one.right && one.top < other.bottom && other.top < one.bottom;

customElements.define("notification-toast", NotificationToast);
