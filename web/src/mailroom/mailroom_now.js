/**
 * Everything that the mailroom has to know, fetched once and kept as it changes.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { Alarm, CampusMap, Order, Page, Robot, Sending } from "../../types/api_types.ts"
 */
import * as api from "../service/api.js";
import { OnLive } from "../live/live.js";
import { asItsRobotSays, hasEnded } from "../orders/order_words.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";

const AT_ONCE = 100;
/** Alarms and mail that was given up have no events of their own: they are looked at again when something happens. */
const POLL_MS = 3_000;
const SOON_MS = 200;
const POLL_ANYWAY_MS = 30_000;

/** @implements {ReactiveController} */
export class MailroomNow {
  /** @type {CampusMap | null} */
  map = null;
  /** @type {Map<string, Order>} those that have not ended */
  orders = new Map();
  /** @type {string | null} where the list of open orders goes on */
  more = null;
  /** @type {Map<string, Robot>} */
  robots = new Map();
  /** @type {Alarm[]} that are not over */
  alarms = [];
  /** @type {Sending[]} mail that is tried no more */
  givenUp = [];
  problem = "";
  #polledAt_ms = -POLL_MS;
  #timer = 0;
  #interval = 0;
  /** Changes received while a request is under way: newer than its answer. @type {{orders: Order[], robots: Robot[]}} */
  #heard = { orders: [], robots: [] };

  /** @param {ReactiveControllerHost} host */
  constructor(host) {
    this.host = host;
    host.addController(this);
    new OnLive(host, {
      order: (order) => this.#hear(() => (this.#heard.orders.push(order), this.take(order))),
      robot: (robot) => this.#hear(() => (this.#heard.robots.push(robot), this.#takeRobot(robot))),
      notice: ({ kind }) => kind === "alarm" && this.poll(),
      resync: () => this.fetch(),
    });
  }

  hostConnected() {
    this.fetch();
    this.#interval = setInterval(() => document.hidden || this.poll(), POLL_ANYWAY_MS);
  }

  hostDisconnected() {
    clearInterval(this.#interval);
    clearTimeout(this.#timer);
  }

  /** @returns {import("./mailroom_words.js").Known} */
  get known() {
    return { orders: [...this.orders.values()], robots: [...this.robots.values()], alarms: this.alarms, givenUp: this.givenUp };
  }

  /** An order as it is now; an older word of it is left aside. @param {Order} order */
  take(order) {
    const before = this.orders.get(order.id);
    if (before && before.version > order.version) return;
    if (hasEnded(order)) this.orders.delete(order.id);
    else this.orders.set(order.id, order);
    this.host.requestUpdate();
  }

  /** @param {Robot} robot */
  #takeRobot(robot) {
    const before = this.robots.get(robot.name) ?? null;
    for (const order of this.orders.values()) {
      if (order.robot?.name === robot.name) this.orders.set(order.id, asItsRobotSays(order, before, robot));
    }
    this.robots.set(robot.name, robot);
  }

  /** @param {() => void} take */
  #hear(take) {
    take();
    this.host.requestUpdate();
    this.poll();
  }

  async fetch() {
    this.#heard = { orders: [], robots: [] };
    await this.#attempt(async () => {
      const [map, robots, [open, stuck]] = await Promise.all([loadMap(), api.robots(), openOrders()]);
      this.map = map;
      this.more = open.next;
      this.robots = new Map([...robots, ...this.#heard.robots].map((robot) => [robot.name, robot]));
      this.orders = new Map();
      for (const order of [...open.items, ...stuck, ...this.#heard.orders]) this.take(order);
    });
    await this.look();
  }

  async fetchMore() {
    await this.#attempt(async () => {
      const older = await api.orders("all", { state: "open", limit: AT_ONCE, cursor: this.more ?? undefined });
      older.items.forEach((order) => this.take(order));
      this.more = older.next;
    });
  }

  /** Not more often than is of use. */
  poll() {
    const pause_ms = Math.max(SOON_MS, this.#polledAt_ms + POLL_MS - performance.now());
    this.#timer ||= setTimeout(() => this.look(), pause_ms);
  }

  async look() {
    clearTimeout(this.#timer);
    [this.#timer, this.#polledAt_ms] = [0, performance.now()];
    await this.#attempt(async () => {
      const [alarms, givenUp] = await Promise.all([api.openAlarms(), api.notSent({ given_up: "true", limit: AT_ONCE })]);
      [this.alarms, this.givenUp] = [alarms.items, givenUp.items];
    });
  }

  /** @param {() => Promise<void>} attempt */
  async #attempt(attempt) {
    try {
      await attempt();
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
    this.host.requestUpdate();
  }
}

/** The newest that are open, and those in attention: asked for apart only where some may be further down.
 *  @returns {Promise<[Page<Order>, Order[]]>} */
async function openOrders() {
  const open = await api.orders("all", { state: "open", limit: AT_ONCE });
  if (open.next === null) return [open, []];
  return [open, (await api.orders("all", { state: "attention", limit: AT_ONCE })).items];
}
