/** My mail: what I sent and what is coming to me, newest first. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { repeatPage } from "../links.js";
import { OnLive } from "../live.js";
import { loadMap } from "../posts.js";
import { inWords } from "../problems.js";
import { t } from "../texts.js";
import { problemLine } from "./field.js";
import { icon } from "./icon.js";
import { orderCard } from "./order_card.js";
import { PageElement } from "./page_element.js";
/** @import { CampusMap, Order, Page } from "../api_types.ts" */

const AT_ONCE = 20;
const ROLES = /** @type {const} */ (["coming", "sent"]);

export class MailPage extends PageElement {
  static properties = { map: { state: true }, lists: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Record<"coming" | "sent", Page<Order>>} */
    this.lists = { coming: { items: [], next: null }, sent: { items: [], next: null } };
    this.problem = "";
    new OnLive(this, { order: (order) => this.#update(order), connected: (connected) => connected && this.#fetch() });
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const { map } = this;
    return html`<h1>${t("mail.title")}</h1>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${map
        ? html`<div class="lists">${ROLES.map((role) => this.#list(role, map))}</div>`
        : html`<p class="waiting" role="status">${t("app.loading")}</p>`}`;
  }

  /** @param {"coming" | "sent"} role @param {CampusMap} map */
  #list(role, map) {
    const { items, next } = this.lists[role];
    return html`<section aria-labelledby="${role}-title">
      <h2 id="${role}-title">${t(`mail.${role}`)}</h2>
      ${items.length
        ? html`<ul class="orders">${items.map((order) => orderCard(order, map, role === "sent" ? repeatLink(order) : nothing))}</ul>`
        : html`<p class="empty">${t(`mail.none_${role}`)}</p>`}
      ${next ? html`<button class="quiet" @click=${() => this.#more(role)}>${t("mail.more")}</button>` : nothing}
    </section>`;
  }

  /** @param {Order} order */
  #update(order) {
    const role = order.my_role === "recipient" ? "coming" : "sent";
    const { items, next } = this.lists[role];
    const known = items.some(({ id }) => id === order.id);
    const updated = known ? items.map((item) => (item.id === order.id ? order : item)) : [order, ...items];
    this.lists = { ...this.lists, [role]: { items: updated, next } };
  }

  /** @param {"coming" | "sent"} role */
  async #more(role) {
    const { items, next } = this.lists[role];
    const older = await api.orders(role, { limit: AT_ONCE, cursor: next ?? undefined });
    this.lists = { ...this.lists, [role]: { items: [...items, ...older.items], next: older.next } };
  }

  async #fetch() {
    try {
      const [map, ...lists] = await Promise.all([loadMap(), ...ROLES.map((role) => api.orders(role, { limit: AT_ONCE }))]);
      this.map = map;
      [this.lists, this.problem] = [{ coming: lists[0], sent: lists[1] }, ""];
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Order} order */
const repeatLink = (order) => html`<a class="again" href=${repeatPage(order)}
  aria-label=${t("mail.repeat_one", { name: order.recipient.name })}>${icon("repeat")}<span>${t("mail.repeat")}</span></a>`;

customElements.define("mail-page", MailPage);
