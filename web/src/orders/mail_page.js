/** My mail: what is coming to me and what I sent, newest first, searched as one types; and what I send again and again. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { repeatPage } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { counted, t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { orderCard } from "./order_card.js";
import { PageElement } from "../elements/page_element.js";
import "./standing_orders.js";
/** @import { CampusMap, Order, Page } from "../../types/api_types.ts" */

const AT_ONCE = 20;
const TYPING_MS = 250;
const ROLES = /** @type {const} */ (["coming", "sent"]);
const STATES = /** @type {const} */ (["all", "open", "ended"]);

export class MailPage extends PageElement {
  #timer = 0;
  /** Which question was asked last: answers to earlier ones come too late. */
  #asked = 0;

  static properties = {
    map: { state: true },
    lists: { state: true },
    search: { state: true },
    state: { state: true },
    looking: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Record<"coming" | "sent", Page<Order> & {only_running?: boolean}>} the latter without a network */
    this.lists = { coming: { items: [], next: null }, sent: { items: [], next: null } };
    this.search = "";
    /** @type {"all" | "open" | "ended"} */
    this.state = "all";
    this.looking = false;
    this.problem = "";
    new Ticking(this, 5_000);
    new OnLive(this, { order: (order) => this.#update(order), resync: () => this.#fetch() });
  }

  firstUpdated() {
    this.#fetch();
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    clearTimeout(this.#timer);
  }

  render() {
    const { map } = this;
    return html`<h1>${t("mail.title")}</h1>
      ${this.#filter()} ${this.problem ? problemLine(this.problem) : nothing}
      ${map
        ? html`<div class="lists">${ROLES.map((role) => this.#list(role, map))}</div>
            <standing-orders .map=${map}></standing-orders>`
        : this.problem ? nothing : html`<p class="waiting" role="status">${t("app.loading")}</p>`}`;
  }

  #filter() {
    return html`<form class="finding" role="search" @submit=${(/** @type {Event} */ event) => event.preventDefault()}>
      <div class="field">
        <label for="field-search">${t("mail.search")}</label>
        <input id="field-search" type="search" maxlength="100" autocomplete="off" aria-describedby="found"
          placeholder=${t("mail.search_hint")} @input=${this.#type} />
      </div>
      <fieldset class="pills">
        <legend class="unseen">${t("mail.which")}</legend>
        ${STATES.map(
          (state) => html`<label class="pill"><input type="radio" name="state" value=${state} .checked=${this.state === state}
            @change=${() => this.#narrow(state)} /><span>${t(`mail.which_${state}`)}</span></label>`,
        )}
      </fieldset>
      <p class="hint" id="found" role="status">${this.#found()}</p>
    </form>`;
  }

  #found() {
    if (!this.search || !this.map) return nothing;
    if (this.looking) return t("mail.looking");
    const { coming, sent } = this.lists;
    return counted(coming.next || sent.next ? "mail.found_more" : "mail.found", coming.items.length + sent.items.length);
  }

  /** @param {"coming" | "sent"} role @param {CampusMap} map */
  #list(role, map) {
    const { items, next, only_running } = this.lists[role];
    const none = only_running ? "none_running" : this.search || this.state !== "all" ? "none_found" : `none_${role}`;
    return html`<section aria-labelledby="${role}-title">
      <h2 id="${role}-title">${t(`mail.${role}`)}</h2>
      ${items.length
        ? html`<ul class="orders">${items.map((order) => orderCard(order, map, role === "sent" ? repeatLink(order) : nothing))}</ul>`
        : html`<p class="empty">${t(`mail.${none}`)}</p>`}
      ${next ? html`<button class="quiet" @click=${() => this.#more(role)}>${t("mail.more")}</button>` : nothing}
    </section>`;
  }

  /** @param {InputEvent} event */
  #type(event) {
    const typed = /** @type {HTMLInputElement} */ (event.target).value.trim();
    if (typed === this.search) return;
    [this.search, this.looking] = [typed, true];
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#fetch(), TYPING_MS);
  }

  /** @param {"all" | "open" | "ended"} state */
  #narrow(state) {
    this.state = state;
    this.#fetch();
  }

  /** Update an order that is shown; add a new one if no filter is set. @param {Order} order */
  #update(order) {
    const role = order.my_role === "recipient" ? "coming" : "sent";
    const { items, next } = this.lists[role];
    const known = items.some(({ id }) => id === order.id);
    if (!known && (this.search || this.state !== "all")) return void this.#fetch();
    const updated = known ? items.map((item) => (item.id === order.id ? order : item)) : [order, ...items];
    this.lists = { ...this.lists, [role]: { items: updated, next } };
  }

  /** @param {"coming" | "sent"} role */
  async #more(role) {
    const { items, next } = this.lists[role];
    const asked = this.#asked;
    await this.#attempt(async () => {
      const older = await this.#ask(role, next ?? undefined);
      if (asked === this.#asked) this.lists = { ...this.lists, [role]: { items: [...items, ...older.items], next: older.next } };
    });
  }

  /** @param {"coming" | "sent"} role @param {string} [cursor] */
  #ask(role, cursor) {
    return api.orders(role, { limit: AT_ONCE, cursor, state: this.state, search: this.search || undefined });
  }

  async #fetch() {
    const asked = (this.#asked += 1);
    await this.#attempt(async () => {
      const [map, coming, sent] = await Promise.all([loadMap(), ...ROLES.map((role) => this.#ask(role))]);
      if (asked !== this.#asked) return;
      [this.map, this.lists, this.looking] = [map, { coming, sent }, false];
    });
  }

  /** @param {() => Promise<unknown>} attempt */
  async #attempt(attempt) {
    try {
      await attempt();
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Order} order */
const repeatLink = (order) => html`<a class="again" href=${repeatPage(order)}
  aria-label=${t("mail.repeat_one", { name: order.recipient.name })}>${icon("repeat")}<span>${t("mail.repeat")}</span></a>`;

customElements.define("mail-page", MailPage);
