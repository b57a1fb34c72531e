/** The first page: what is under way, and the form for the next letter beside the map. */
import { html, nothing } from "lit";
import { newestOrders } from "../service/early.js";
import { wantedFrom } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { hasEnded } from "./order_words.js";
import { loadMap } from "../service/posts.js";
import { wantsFirstHelp } from "../session/session.js";
import { t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import { orderCard } from "./order_card.js";
import "./order_form.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, Order, WantedOrder } from "../../types/api_types.ts" */

export class OrderPage extends PageElement {
  static properties = {
    map: { state: true },
    orders: { state: true },
    wanted: { state: true },
    problem: { state: true },
    help: { state: true },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Order[]} mine, sent and coming, newest first */
    this.orders = [];
    /** @type {WantedOrder} */
    this.wanted = {
      ...{ from_post: "", to_post: "", recipient: "", description: "" },
      ...wantedFrom(location.search),
    };
    this.problem = "";
    this.help = false;
    new OnLive(this, {
      order: (order) => (this.orders = [order, ...this.orders.filter(({ id }) => id !== order.id)]),
      resync: () => this.#fetch(),
    });
  }

  firstUpdated() {
    this.#fetch();
  }

  /** @param {Map<string, unknown>} changed */
  updated(changed) {
    const overview = changed.has("map") && this.querySelector(".overview");
    if (overview) import("../map/map_later.js").then(({ fetchMapWhenSeen }) => fetchMapWhenSeen(overview));
  }

  render() {
    const { map } = this;
    if (!map) return this.problem ? html`<h1>${t("order.title")}</h1>${problemLine(this.problem)}` : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    return html`
      ${this.help ? html`<first-steps @put-away=${() => (this.help = false)}></first-steps>` : nothing} ${this.#underWay(map)}
      <div class="ordering">
        <div>
          <h1>${t("order.title")}</h1>
          <p class="lead">${t("order.lead")}</p>
          <order-form .map=${map} .wanted=${this.wanted} .sent=${this.orders.filter(({ my_role }) => my_role === "sender")}
            @wanted=${(/** @type {CustomEvent<WantedOrder>} */ event) => (this.wanted = event.detail)}></order-form>
        </div>
        <section class="card overview" aria-labelledby="overview-title">
          <h2 id="overview-title">${map.title}</h2>
          <campus-map .map=${map} .from=${this.wanted.from_post} .to=${this.wanted.to_post}></campus-map>
          <p class="hint">${map.note}</p>
        </section>
      </div>
    `;
  }

  /** @param {CampusMap} map */
  #underWay(map) {
    const open = this.orders.filter((order) => !hasEnded(order));
    if (!open.length) return nothing;
    return html`<section class="under-way" aria-labelledby="under-way-title">
      <h2 id="under-way-title">${t("order.under_way")}</h2>
      <ul class="orders">${open.map((order) => orderCard(order, map))}</ul>
    </section>`;
  }

  async #fetch() {
    try {
      const [map, mine] = await Promise.all([loadMap(), newestOrders()]);
      this.map = map;
      this.orders = mine.items;
      this.help ||= wantsFirstHelp(!mine.items.length);
      if (this.help) import("../session/first_steps.js");
      const newest = mine.items.find(({ my_role }) => my_role === "sender");
      if (newest && !this.wanted.from_post) this.wanted = { ...this.wanted, from_post: newest.from_post };
    } catch (failure) {
      this.problem = await inWords(failure);
    }
  }
}

/** Say that the service does not answer, where the module for its words cannot be fetched either. @param {unknown} failure */
const inWords = (failure) => import("../service/problems.js").then((problems) => problems.inWords(failure), () => t("error.no_answer"));

customElements.define("order-page", OrderPage);
