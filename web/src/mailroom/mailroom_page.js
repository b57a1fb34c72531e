/** The mailroom on one screen: what is wrong and how it is mended, the queue, the robots, the map. */
import { html, nothing } from "lit";
import { expectedWithOrders } from "../orders/arrival.js";
import * as api from "../service/api.js";
import { Closures } from "../live/closures.js";
import { OnLive } from "../live/live.js";
import { orderActions } from "./mailroom_actions.js";
import { MailroomNow } from "./mailroom_now.js";
import { isHeldUp, orderTitle, openIssues } from "./mailroom_words.js";
import { fetchMapWhenSeen } from "../map/map_later.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { TrafficNow } from "../live/traffic.js";
import "../elements/ask_dialog.js";
import { closedCorridors } from "./closed_corridors.js";
import { problemLine } from "../elements/field.js";
import { mailroomDialogs, mailroomTools } from "./mailroom_tools.js";
import "./order_queue.js";
import { PageElement } from "../elements/page_element.js";
import { robotBoard } from "./robot_board.js";
import { sectionLinks } from "../elements/section_links.js";
import { issueList } from "./issue_list.js";
/** @import { Alarm, CampusMap, Command, Order, Sending } from "../../types/api_types.ts" */
/** @import { Action } from "./mailroom_actions.js" */
/** @import { AskDialog } from "../elements/ask_dialog.js" */

const REDRAW_MS = 5_000;
const MAKE_IT_WAIT = ["pause", "emergency_stop"];

export class MailroomPage extends PageElement {
  static properties = { said: { state: true }, problem: { state: true } };
  now = new MailroomNow(this);
  traffic = new TrafficNow(this);
  corridors = new Closures(this);
  /** Robots that were told to wait and have not said yet that they do. @type {Set<string>} */
  #asked = new Set();
  #hasPlaceForMap = false;
  #doing = {
    ask: (/** @type {Action} */ action, /** @type {string} */ about) => this.#ask([action], about),
    acknowledge: (/** @type {Alarm} */ alarm) => this.#do("alarm.acknowledged", () => api.acknowledgeAlarm(alarm.id)),
    sendAgain: (/** @type {Sending} */ sending) => this.#do("mailroom.retried", () => api.sendAgain(sending.id)),
    isAskedToWait: (/** @type {string} */ robot) => this.#asked.has(robot),
  };

  constructor() {
    super();
    /** The result of the last action. */
    this.said = "";
    this.problem = "";
    new Ticking(this, REDRAW_MS);
    new OnLive(this, { robot: (robot) => void (isHeldUp(robot) && this.#asked.delete(robot.name)) });
  }

  render() {
    const { map, problem } = this.now;
    if (!map) return problem ? html`<h1>${t("mailroom.title")}</h1>${problemLine(problem)}` : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    const { known } = this.now;
    const issues = openIssues(known);
    return html`<div class="title-line">
        <h1>${t("mailroom.title")}</h1>
        ${mailroomTools()}
      </div>
      ${sectionLinks([
        { id: "wrong-title", label: t("mailroom.section.wrong"), count: issues.length, wrong: true },
        { id: "queue-title", label: t("mailroom.queue"), count: known.orders.length },
        { id: "robots-title", label: t("mailroom.robots"), count: known.robots.length },
        { id: "corridors-title", label: t("corridors.title"), count: this.corridors.closed.length, wrong: true },
        { id: "map-title", label: t("mailroom.map") },
      ])}
      <p class="said" role="status">${this.said}</p>
      ${this.problem || problem ? problemLine(this.problem || problem) : nothing}
      ${this.#wrong(issues, map)}
      <div class="mailroom">
        <order-queue .map=${map} .orders=${known.orders} ?more=${this.now.more !== null} @more=${() => this.now.fetchMore()}
          @act=${(/** @type {CustomEvent<Order>} */ event) => this.#act(event.detail)}></order-queue>
        <div class="side">
          <section class="card" aria-labelledby="robots-title">
            <h2 id="robots-title" tabindex="-1">${t("mailroom.robots")} <span class="count">${known.robots.length}</span></h2>
            ${robotBoard(known.robots, known.alarms, map, this.#doing)}
          </section>
          <section class="card" aria-labelledby="corridors-title">
            <h2 id="corridors-title" tabindex="-1">${t("corridors.title")}
              ${this.corridors.closed.length ? html`<span class="count">${this.corridors.closed.length}</span>` : nothing}</h2>
            ${closedCorridors(this.corridors.closed, map, this.#doing)}
          </section>
          <section class="card" aria-labelledby="map-title">
            <h2 id="map-title" tabindex="-1">${map.title}</h2>
            <campus-map .map=${map} .robots=${expectedWithOrders(known.robots, known.orders, serverNow())} .traffic=${this.traffic.taken} .reported=${this.traffic.reported} .alarms=${known.alarms}
              .closed=${this.corridors.closed}></campus-map>
          </section>
        </div>
      </div>
      <ask-dialog @done=${this.#done} @refused=${() => this.now.fetch()}></ask-dialog>
      ${mailroomDialogs()}`;
  }

  updated() {
    const place = this.#hasPlaceForMap ? null : this.querySelector("campus-map");
    if (!place) return;
    this.#hasPlaceForMap = true;
    fetchMapWhenSeen(place);
  }

  /** @param {ReturnType<typeof openIssues>} issues @param {CampusMap} map */
  #wrong(issues, map) {
    return html`<section class="card wrong" aria-labelledby="wrong-title">
      <h2 id="wrong-title" tabindex="-1">${t("mailroom.wrong")}
        ${issues.length ? html`<span class="count">${issues.length}</span>` : nothing}</h2>
      ${issueList(issues, map, this.#doing)}
    </section>`;
  }

  /** @param {Order} order */
  #act(order) {
    this.#ask(orderActions(order, this.now.known.robots, this.now.map), orderTitle(order));
  }

  /** @param {Action[]} actions @param {string} about */
  #ask(actions, about) {
    const dialog = /** @type {AskDialog} */ (this.querySelector("ask-dialog"));
    dialog.ask(actions, about);
  }

  /** @param {CustomEvent<{action: Action, answer: any}>} event */
  #done({ detail: { action, answer } }) {
    this.said = t(`mailroom.do.${action.name}.done`, action.names);
    if (answer?.version) this.now.take(answer);
    if (answer?.closed) this.corridors.show(answer.closed);
    if (answer?.command_id) this.#told(answer);
    this.#keepFocus();
    this.now.poll();
  }

  /** @param {Command} command */
  #told({ robot, kind, online }) {
    if (kind === "resume") this.#asked.delete(robot);
    else if (MAKE_IT_WAIT.includes(kind)) this.#asked.add(robot);
    if (!online) this.said += ` ${t("mailroom.hears_later", { robot })}`;
  }

  /** @param {string} said @param {() => Promise<unknown>} doing */
  async #do(said, doing) {
    this.problem = "";
    try {
      await doing();
      this.said = t(said);
    } catch (failure) {
      this.problem = inWords(failure);
    }
    await this.now.look();
    this.#keepFocus();
  }

  /** Move the focus to the remaining issues when the pressed button is gone. */
  async #keepFocus() {
    await this.updateComplete;
    if (!document.activeElement || document.activeElement === document.body) this.focusOn("#wrong-title");
  }
}

customElements.define("mailroom-page", MailroomPage);
