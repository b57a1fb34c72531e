/** The queue: what is under way, as the page knows it, or what a search finds; sorted as one likes, page after page. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { orderTitle, sorted, SORTING_NAMES } from "./mailroom_words.js";
import { OnLive } from "../live/live.js";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
import { queueList } from "./queue_list.js";
/** @import { CampusMap, Order, Page } from "../../types/api_types.ts" */

const AT_ONCE = 50;
const TYPING_MS = 300;
const STATES = /** @type {const} */ (["open", "ended"]);

export class OrderQueue extends PageElement {
  #timer = 0;

  static properties = {
    map: { attribute: false },
    orders: { attribute: false },
    more: { type: Boolean },
    sorting: { state: true },
    state: { state: true },
    search: { state: true },
    found: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Order[]} what is under way */
    this.orders = [];
    /** True if there are further pages. */
    this.more = false;
    this.sorting = SORTING_NAMES[0];
    /** @type {"open" | "ended"} */
    this.state = STATES[0];
    this.search = "";
    /** @type {Page<Order> | null} what was searched for; null: nothing was */
    this.found = null;
    this.problem = "";
    new OnLive(this, { order: (order) => this.#update(order) });
  }

  render() {
    const { map } = this;
    if (!map) return nothing;
    const shown = this.found ? this.found.items : sorted(this.orders, this.sorting, map);
    return html`<section class="card" aria-labelledby="queue-title">
      <div class="title-line">
        <h2 id="queue-title" tabindex="-1">${t("mailroom.queue")} <span class="count">${shown.length}</span></h2>
        ${this.#filters()}
      </div>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${shown.length ? queueList(shown, map, orderTitle, (order) => this.#act(order)) : html`<p class="empty">${t(this.found ? "mailroom.found_none" : "mailroom.queue_empty")}</p>`}
      ${(this.found ? this.found.next : this.more)
        ? html`<button type="button" class="quiet" @click=${this.#more}>${t("mailroom.more")}</button>`
        : nothing}
    </section>`;
  }

  #filters() {
    return html`<div class="filters" role="search" aria-label=${t("mailroom.search_orders")}>
      <input type="search" aria-label=${t("mailroom.search")} placeholder=${t("mailroom.search")} .value=${this.search}
        @input=${(/** @type {InputEvent} */ event) => this.#find({ search: /** @type {HTMLInputElement} */ (event.target).value })} />
      <select aria-label=${t("mailroom.show")} @change=${(/** @type {Event} */ event) => this.#find({ state: /** @type {HTMLSelectElement} */ (event.target).value })}>
        ${STATES.map((state) => html`<option value=${state} .selected=${state === this.state}>${t(`mailroom.show.${state}`)}</option>`)}
      </select>
      ${this.found ? nothing : html`<select aria-label=${t("mailroom.sort")} @change=${(/** @type {Event} */ event) => (this.sorting = /** @type {HTMLSelectElement} */ (event.target).value)}>
        ${SORTING_NAMES.map((name) => html`<option value=${name} .selected=${name === this.sorting}>${t(`mailroom.sort.${name}`)}</option>`)}
      </select>`}
    </div>`;
  }

  /** @param {{search?: string, state?: string}} wanted */
  #find(wanted) {
    Object.assign(this, wanted);
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#look(), wanted.search === undefined ? 0 : TYPING_MS);
  }

  async #look() {
    const { search, state } = this;
    if (!search.trim() && state === STATES[0]) return void ([this.found, this.problem] = [null, ""]);
    await this.#attempt(async () => {
      const found = await api.orders("all", this.#page());
      if (search === this.search && state === this.state) this.found = found;
    });
  }

  /** @param {string} [cursor] */
  #page(cursor) {
    return { state: this.state, search: this.search.trim() || undefined, limit: AT_ONCE, cursor };
  }

  async #more() {
    const { found } = this;
    if (!found) return void this.dispatchEvent(new CustomEvent("more"));
    await this.#attempt(async () => {
      const older = await api.orders("all", this.#page(found.next ?? undefined));
      this.found = { items: [...found.items, ...older.items], next: older.next };
    });
  }

  /** Update an order among the search results. @param {Order} order */
  #update(order) {
    if (!this.found) return;
    this.found = { ...this.found, items: this.found.items.map((one) => (one.id === order.id && one.version <= order.version ? order : one)) };
  }

  /** @param {Order} order */
  #act(order) {
    this.dispatchEvent(new CustomEvent("act", { detail: order }));
  }

  /** @param {() => Promise<void>} attempt */
  async #attempt(attempt) {
    try {
      await attempt();
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("order-queue", OrderQueue);
