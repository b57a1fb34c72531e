/** One order for a guest, opened by the link in a mail: where it stands, the code, "not now". No account, no event stream. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { askedOrKept } from "../offline/kept_link.js";
import { speak } from "../texts/language.js";
import { hasEnded, isAtAStop, isMyTurn, stateSentence } from "../orders/order_words.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { ShowsOutcome } from "./shows_outcome.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { problemLine } from "../elements/field.js";
import "./handover_code.js";
import { icon } from "../elements/icon.js";
import "../elements/opens_later.js";
import { asking, mayRefuse, notNowWords } from "./order_actions.js";
import { orderDetails } from "./order_details.js";
import { loadDelegates, loadDigits } from "./rare_actions.js";
import { orderStanding } from "./order_standing.js";
import { orderTimeline } from "./order_timeline.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, Order } from "../../types/api_types.ts" */
/** @import { Naming } from "./order_delegates.js" */

const POLL_MS = 5_000;
// Each in its own language: a reader may know no other.
const LANGUAGES = { en: "English", fr: "Français" };

export class OneOrder extends PageElement {
  #timer = 0;

  static properties = {
    token: { attribute: false },
    order: { state: true },
    map: { state: true },
    problem: { state: true },
    unreached: { state: true },
  };

  constructor() {
    super();
    this.token = "";
    new ShowsOutcome(this);
    new Ticking(this);
    /** @type {Order | null} */
    this.order = null;
    /** @type {CampusMap | null} */
    this.map = null;
    this.problem = "";
    /** True if the last request had no answer: the page shows the last known state, if there is one. */
    this.unreached = false;
    this.door = {
      code: async () => (await askedOrKept(this.token, "code", () => api.linkedCode(this.token))).answer,
      handOver: (/** @type {string | undefined} */ digits) => api.linkedHandOver(this.token, digits),
      showToCamera: null,
    };
    /** The calls for delegates of a guest, who sees each code only once. @type {Naming} */
    this.naming = { name: (request) => api.linkedDelegate(this.token, request), list: null, revoke: notHere, code: notHere };
  }

  connectedCallback() {
    super.connectedCallback();
    this.#timer = setInterval(() => document.hidden || this.#look(), POLL_MS);
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
    return html`${this.#languages()}
      ${this.unreached ? html`<p class="banner" role="status">${icon("network")}${t("one_order.unreached")}</p>` : nothing}
      <div class="follow">
      <div class="column">
        ${orderStanding(order, map)}
        <handover-code .door=${this.door} .purpose=${order.my_code} .needed=${isMyTurn(order)}
          .asked=${order.handover_requested !== null}></handover-code>
        ${this.#others(order)}
        ${mayRefuse(order)
          ? html`<div class="choices">${asking(notNowWords(order), () => api.linkedNotNow(this.token), (changed) => (this.order = changed))}</div>`
          : nothing}
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

  /** @param {Order} order */
  #others(order) {
    return [
      isAtAStop(order)
        ? html`<opens-later .label=${t("follow.digits.open")} .drawing=${"dial"} .load=${loadDigits}
            .content=${() => html`<digits-entry .door=${this.door}></digits-entry>`}></opens-later>`
        : nothing,
      order.my_role === "recipient" && !hasEnded(order)
        ? html`<opens-later .label=${t("delegate.open")} .load=${loadDelegates}
            .content=${() => html`<order-delegates .naming=${this.naming}></order-delegates>`}></opens-later>`
        : nothing,
    ];
  }

  #languages() {
    return html`<p class="languages">
      ${Object.entries(LANGUAGES)
        .filter(([tag]) => tag !== document.documentElement.lang)
        .map(([tag, name]) => html`<button class="quiet" lang=${tag} @click=${() => speak(tag)}>${name}</button>`)}
    </p>`;
  }

  updated() {
    if (this.order && this.map) document.title = `${stateSentence(this.order, this.map, serverNow())} · ${t("app.name")}`;
  }

  #refused() {
    return html`<section class="blank">
      <h1>${t(this.unreached ? "app.failed.title" : "one_order.refused")}</h1>
      ${problemLine(this.problem)}
    </section>`;
  }

  async #look() {
    if (this.order && hasEnded(this.order)) return;
    try {
      const [map, { answer, isKept }] = await Promise.all([
        loadMap(),
        askedOrKept(this.token, "order", () => api.linkedOrder(this.token)),
      ]);
      [this.map, this.order, this.unreached, this.problem] = [map, answer, isKept, ""];
    } catch (failure) {
      this.unreached = failure instanceof api.NoAnswer;
      this.problem = this.unreached ? (this.order ? "" : t("error.not_loaded")) : inWords(failure);
    }
  }
}

/** The service lists no delegates by a link. */
const notHere = () => Promise.reject(new Error());

customElements.define("one-order", OneOrder);
