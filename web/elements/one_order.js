/** One order for whoever came by the link in a mail: where it stands, the code, "not now". No account, no event stream. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { hasEnded, isMyTurn, stateSentence } from "../order_words.js";
import { loadMap } from "../posts.js";
import { inWords } from "../problems.js";
import { t } from "../texts.js";
import { problemLine } from "./field.js";
import "./handover_code.js";
import { orderDetails } from "./order_details.js";
import { orderStanding } from "./order_standing.js";
import { orderTimeline } from "./order_timeline.js";
import { PageElement } from "./page_element.js";
/** @import { CampusMap, Order } from "../api_types.ts" */

const LOOK_EVERY_MS = 5_000;

export class OneOrder extends PageElement {
  #timer = 0;

  static properties = {
    token: { attribute: false },
    order: { state: true },
    map: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    this.token = "";
    /** @type {Order | null} */
    this.order = null;
    /** @type {CampusMap | null} */
    this.map = null;
    this.problem = "";
    this.door = {
      code: () => api.linkedCode(this.token),
      handOver: () => api.linkedHandOver(this.token),
      showToCamera: null,
    };
  }

  connectedCallback() {
    super.connectedCallback();
    this.#timer = setInterval(() => document.hidden || this.#look(), LOOK_EVERY_MS);
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    clearInterval(this.#timer);
  }

  firstUpdated() {
    this.#look();
  }

  render() {
    const { order, map } = this;
    if (!order || !map) return this.problem ? this.#refused() : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    return html`<div class="follow">
      <div class="column">
        ${orderStanding(order, map)}
        <handover-code .door=${this.door} .purpose=${order.my_code} .needed=${isMyTurn(order)}
          .asked=${order.handover_requested !== null}></handover-code>
        ${order.state === "at_recipient" && order.my_role === "recipient" ? html`<button class="quiet" @click=${this.#notNow}>${t("one_order.not_now")}</button>` : nothing}
        ${this.problem ? problemLine(this.problem) : nothing}
      </div>
      <div class="column">
        ${order.my_role === "delegate" ? nothing : this.#timeline(order, map)} ${orderDetails(order)}
      </div>
    </div>`;
  }

  /** @param {Order} order @param {CampusMap} map */
  #timeline(order, map) {
    return html`<section class="card" aria-labelledby="timeline-title">
      <h2 id="timeline-title">${t("follow.timeline")}</h2>
      ${orderTimeline(order, map)}
    </section>`;
  }

  updated() {
    if (this.order && this.map) document.title = `${stateSentence(this.order, this.map)} · ${t("app.name")}`;
  }

  #refused() {
    return html`<section class="blank">
      <h1>${t("one_order.refused")}</h1>
      ${problemLine(this.problem)}
    </section>`;
  }

  async #look() {
    if (this.order && hasEnded(this.order)) return;
    await this.#attempt(async () => {
      const [map, order] = await Promise.all([loadMap(), api.linkedOrder(this.token)]);
      [this.map, this.order] = [map, order];
    });
  }

  async #notNow() {
    await this.#attempt(async () => (this.order = await api.linkedNotNow(this.token)));
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

customElements.define("one-order", OneOrder);
