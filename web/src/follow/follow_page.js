/** One order, followed: where it stands, when it arrives, what to do, where the robot was seen, what has happened. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { arrivalOf } from "../orders/arrival.js";
import { followedOrder } from "../service/early.js";
import { PAGES } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { asItsRobotSays, hasEnded, isAtAStop, isMyTurn, orderWhy, stateSentence } from "../orders/order_words.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { ShowsOutcome } from "./shows_outcome.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { TrafficNow } from "../live/traffic.js";
import { orderActions } from "./order_actions.js";
import { loadDelegates, loadDigits } from "./rare_actions.js";
import { orderCustody, orderDetails } from "./order_details.js";
import { arrivalWindow, orderStanding } from "./order_standing.js";
import { orderTimeline } from "./order_timeline.js";
import { problemLine } from "../elements/field.js";
import "./handover_code.js";
import "../elements/opens_later.js";
import { PageElement } from "../elements/page_element.js";
import "./wait_longer.js";
/** @import { CampusMap, Order, Robot } from "../../types/api_types.ts" */
/** @import { Door } from "./handover_code.js" */
/** @import { Naming } from "./order_delegates.js" */

const WAITING = ["waiting", "charging", "stopped"];

export class FollowPage extends PageElement {
  /** A count of received events. */
  #heard = 0;
  #door = this.#ownDoor();
  #ownNaming = this.#naming();
  #traffic = new TrafficNow(this);

  static properties = {
    order_id: { attribute: false },
    demo: { type: Boolean },
    order: { state: true },
    map: { state: true },
    robot: { state: true },
    problem: { state: true },
    unreached: { state: true },
  };

  constructor() {
    super();
    this.order_id = "";
    this.demo = false;
    /** @type {Order | null} */
    this.order = null;
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Robot | null} */
    this.robot = null;
    this.problem = "";
    /** True if the service could not be asked. */
    this.unreached = false;
    new ShowsOutcome(this);
    new Ticking(this);
    new OnLive(this, {
      order: (order) => order.id === this.order_id && this.#hear(() => this.#show(order)),
      robot: (robot) => this.#concerns(robot) && this.#hear(() => this.#showRobot(robot)),
      resync: () => this.#fetch(),
    });
  }

  firstUpdated() {
    this.#fetch();
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("order_id") || changed.has("demo")) [this.#door, this.#ownNaming] = [this.#ownDoor(), this.#naming()];
  }

  /** The calls for the code and the hand-over of a person who is signed in. @returns {Door} */
  #ownDoor() {
    const id = this.order_id;
    const showToCamera = this.demo ? () => api.showCodeToCamera(id) : null;
    return { code: () => api.handoverCode(id), handOver: (digits) => api.handOver(id, digits), showToCamera };
  }

  /** The calls for delegates of a person who is signed in. @returns {Naming} */
  #naming() {
    const id = this.order_id;
    return {
      name: async (request) => {
        const delegate = await api.nameDelegate(id, request);
        return { delegate, code: await api.delegateCode(id, delegate.id) };
      },
      list: () => api.delegates(id),
      revoke: (delegate_id) => api.revokeDelegate(id, delegate_id),
      code: (delegate_id) => api.delegateCode(id, delegate_id),
    };
  }

  render() {
    if (this.problem) return this.#notHere();
    if (!this.order || !this.map) return html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    const { order, map } = this;
    return html`<div class="follow">
      <div class="column">
        ${orderStanding(order, map)}
        <handover-code .door=${this.#door} .purpose=${order.my_code} .needed=${isMyTurn(order)}
          .asked=${order.handover_requested !== null}></handover-code>
        ${isMyTurn(order) ? this.#whileItWaits(order, map) : nothing}
        ${this.#why(order, map)} ${this.#others(order)}
        <section class="card" aria-labelledby="timeline-title">
          <h2 id="timeline-title">${t("follow.timeline")}</h2>
          ${orderTimeline(order, map)}
        </section>
      </div>
      <div class="column">
        <section class="card where" aria-labelledby="map-title">
          <h2 id="map-title">${t(hasEnded(order) ? "follow.map_ended" : "follow.map")}</h2>
          <campus-map .map=${map} .robots=${hasEnded(order) || !this.robot ? [] : [this.robot]} .traffic=${this.#traffic.taken} .reported=${this.#traffic.reported}
            .arrival=${this.#arrival(order)} .from=${order.passed_on_at_post ?? order.from_post} .to=${order.to_post} ?facts=${!hasEnded(order)}></campus-map>
        </section>
        ${orderCustody(order)} ${orderDetails(order)} ${orderActions(order, (changed) => this.#show(changed))}
      </div>
    </div>`;
  }

  updated() {
    // After the words: where the letter stands is what people come for.
    if (this.order && this.map) import("../map/map_later.js").then(({ fetchMap }) => fetchMap());
    if (this.order && this.map) document.title = `${stateSentence(this.order, this.map, serverNow())} · ${t("app.name")}`;
  }

  /** Below the code, which is needed first. @param {Order} order @param {CampusMap} map */
  #whileItWaits(order, map) {
    return html`${order.my_code === "load" ? html`<section class="card">${arrivalWindow(order, map)}</section>` : nothing}
      <wait-longer .order=${order} @changed=${(/** @type {CustomEvent<Order>} */ event) => this.#show(event.detail)}></wait-longer>`;
  }

  /** The map tells the time that all of the page tells. @param {Order} order */
  #arrival(order) {
    const arrival = arrivalOf(order, serverNow());
    return hasEnded(order) ? null : { post: order.to_post, window: arrival?.window ?? null };
  }

  /** The service's word about this order, never what its robot does elsewhere; said once, where no time is known beside that.
   *  A robot that is on its way waits for nothing. @param {Order} order @param {CampusMap} map */
  #why(order, map) {
    const { robot } = this;
    const arrival = isMyTurn(order) ? null : arrivalOf(order, serverNow());
    if (!order.why || hasEnded(order) || (arrival && !arrival.window) || (robot && !WAITING.includes(robot.activity))) return nothing;
    return html`<section class="card why" aria-labelledby="why-title">
      <h2 id="why-title">${t("follow.why")}</h2>
      <p>${orderWhy({ ...order, robot: robot ?? order.robot }, map)}</p>
    </section>`;
  }

  /** Rare actions: name a delegate; enter digits instead of using the camera. @param {Order} order */
  #others(order) {
    const isMine = order.my_role === "recipient" ? !hasEnded(order) : order.my_role === "sender" && order.my_code !== null;
    return [
      isAtAStop(order)
        ? html`<opens-later .label=${t("follow.digits.open")} .drawing=${"dial"} .load=${loadDigits}
            .content=${() => html`<digits-entry .door=${this.#door}></digits-entry>`}></opens-later>`
        : nothing,
      isMine
        ? html`<opens-later .label=${t("delegate.open")} .load=${loadDelegates}
            .content=${() => html`<order-delegates .naming=${this.#ownNaming}></order-delegates>`}></opens-later>`
        : nothing,
    ];
  }

  #notHere() {
    return html`<section class="blank">
      <h1>${t(this.unreached ? "app.failed.title" : "follow.unknown.title")}</h1>
      ${problemLine(this.problem)}
      <a class="button" href=${PAGES.mail}>${t("follow.unknown.back")}</a>
    </section>`;
  }

  /** @param {Order} order */
  #show(order) {
    if (this.order && order.version < this.order.version) return;
    if (this.order && order.robot?.name !== this.order.robot?.name) this.#traffic.fetch();
    this.order = order;
    this.robot = order.robot;
  }

  /** @param {Robot} robot */
  #showRobot(robot) {
    if (this.order) this.order = asItsRobotSays(this.order, this.robot, robot);
    this.robot = robot;
  }

  /** Before the first answer any robot may be the one. @param {Robot} robot */
  #concerns(robot) {
    return this.order === null || robot.name === this.order.robot?.name;
  }

  /** @param {() => void} take */
  #hear(take) {
    take();
    this.#heard += 1;
  }

  /** An answer may be older than what is heard while it is on its way: then it is asked for again. */
  async #fetch() {
    let heard;
    do {
      heard = this.#heard;
      await this.#ask();
    } while (heard !== this.#heard);
  }

  async #ask() {
    try {
      const [map, order] = await Promise.all([loadMap(), followedOrder(this.order_id)]);
      [this.map, this.problem] = [map, ""];
      this.#show(order);
    } catch (failure) {
      this.unreached = failure instanceof api.NoAnswer;
      if (!this.order) this.problem = failure instanceof api.ApiProblem ? t("follow.unknown.body") : inWords(failure);
    }
  }
}

customElements.define("follow-page", FollowPage);
