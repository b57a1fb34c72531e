/**
 * The event stream of changes: one for all tabs of a browser. One tab that is seen reads it (whichever has
 * the lock) and passes on what it hears; where no tab is seen there is none. docs/decisions/0069 says why.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { Position } from "../service/api.js"
 * @import { ClosedCorridors, NotificationView, Order, Robot, RobotTraffic, Watched } from "../../types/api_types.ts"
 * @typedef {{order: Order, robot: Robot, traffic: RobotTraffic, closed: ClosedCorridors, notice: NotificationView, insight: Watched, connected: boolean, resync: null}} Changes
 * @typedef {object} Message what the tab that reads tells the others
 * @property {Position} after the place in the stream up to which it had told everything before
 * @property {boolean} [open] whether the stream stands
 * @property {{kind: keyof Changes, data: string, id: string}} [event]
 */
import * as api from "../service/api.js";

const OPEN_AGAIN_MS = 3_000;
const KINDS = /** @type {const} */ (["order", "robot", "traffic", "closed", "notice", "insight", "resync"]);

/** Tells `order`, `robot`, `traffic`, `closed`, `notice` and `insight` as they come, `resync` when everything that is shown
 * has to be fetched anew, and `connected` when the stream breaks (false) or stands again (true). */
export class LiveFeed extends EventTarget {
  /** @type {BroadcastChannel | null} */
  #channel = null;
  /** This tab's place in the queue for the lock, or the lock. @type {AbortController | null} */
  #turn = null;
  /** @type {EventSource | null} */
  #source = null;
  /** Up to where this tab knows everything. @type {Position} */
  #known = undefined;
  /** @type {boolean | null} */
  #connected = null;
  /** True if the data has to be fetched anew, once there is a stream and the page is visible. */
  #isStale = false;
  #look = () => (document.hidden ? this.#leave() : this.#join());

  /** @param {string} person_id whose stream it is: another tab may still belong to a person who has left */
  async start(person_id) {
    this.stop();
    const name = `live ${person_id}`;
    const channel = (this.#channel = new BroadcastChannel(name));
    /** @type {Message[] | null} */
    let early = [];
    channel.onmessage = ({ data }) => (early ? early.push(data) : this.#hear(data));
    const position = await api.positionOfAnswers();
    await new Promise((resolve) => setTimeout(resolve)); // the caller gets the answer before any newer event
    if (this.#channel !== channel) return;
    if (this.#known === undefined) [this.#known, this.#isStale] = [position, position === null];
    for (const message of early) this.#hear(message);
    early = null;
    channel.postMessage("hello");
    document.addEventListener("visibilitychange", this.#look);
    this.#look();
  }

  stop() {
    document.removeEventListener("visibilitychange", this.#look);
    this.#leave();
    this.#channel?.close();
    this.#channel = null;
  }

  /** Where a page may not have locks (plain http from another machine), each tab that is seen has a stream of its own. */
  #join() {
    this.#freshen();
    if (this.#turn || !this.#channel) return;
    const { signal } = (this.#turn = new AbortController());
    const hold = () => signal.aborted || new Promise((resolve) => (signal.addEventListener("abort", resolve), this.#open()));
    if (!navigator.locks) hold();
    // Who leaves before their turn comes has it refused.
    else navigator.locks.request(this.#channel.name, { signal }, hold).catch(() => undefined);
  }

  #leave() {
    this.#source?.close();
    this.#source = null;
    this.#turn?.abort();
    this.#turn = null;
  }

  #open() {
    const source = (this.#source = api.openLive(this.#known ?? null));
    for (const kind of KINDS) {
      source.addEventListener(kind, ({ data, lastEventId }) => this.#pass({ event: { kind, data, id: lastEventId } }));
    }
    source.onopen = () => this.#pass({ open: true });
    source.onerror = () => this.#broken(source);
  }

  /** The browser opens a broken stream again by itself, but not one that was refused. @param {EventSource} source */
  #broken(source) {
    this.#pass({ open: false });
    if (source.readyState !== EventSource.CLOSED) return;
    setTimeout(() => source === this.#source && this.#open(), OPEN_AGAIN_MS);
  }

  /** @param {Omit<Message, "after">} news */
  #pass(news) {
    const told = { ...news, after: this.#known };
    if (navigator.locks) this.#channel?.postMessage(told);
    this.#hear(told);
  }

  /** True while the stream is open. */
  get stands() {
    return this.#connected === true;
  }

  /** @param {Message | "hello"} message */
  #hear(message) {
    if (message === "hello") return void (this.#source && this.#connected !== null && this.#pass({ open: this.#connected }));
    const { after, open, event } = message;
    this.#isStale ||= event?.kind === "resync" || (after !== this.#known && api.isAfter(after, this.#known));
    for (const position of [after, event?.id]) if (position && api.isAfter(position, this.#known)) this.#known = position;
    if (event && event.kind !== "resync") this.#tell(event.kind, JSON.parse(event.data));
    if (open !== undefined && open !== this.#connected) this.#stand(open);
    this.#freshen();
  }

  /** @param {boolean} connected */
  async #stand(connected) {
    this.#connected = connected;
    this.#tell("connected", connected);
    if (!connected || (await api.positionOfAnswers()) !== null) return;
    this.#isStale = true;
    this.#freshen();
  }

  #freshen() {
    if (!this.#isStale || !this.#connected || document.hidden) return;
    this.#isStale = false;
    this.#tell("resync", null);
  }

  /** @param {keyof Changes} kind @param {unknown} detail */
  #tell(kind, detail) {
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }
}

const feed = new LiveFeed();

/** Hear what changes, and hold nothing open behind a page that has been left. @param {string} person_id */
export function startLive(person_id) {
  feed.start(person_id);
  addEventListener("pagehide", () => feed.stop());
  addEventListener("pageshow", (event) => event.persisted && feed.start(person_id));
}

/** True while this page receives events. */
export const isLive = () => feed.stands;

/** End the stream after a sign-out. */
export const stopLive = () => feed.stop();

/** They are again. @param {string} person_id */
export const goOnLive = (person_id) => feed.start(person_id);

/** Lets an element hear changes for as long as it is on the page. @implements {ReactiveController} */
export class OnLive {
  /** @type {AbortController | null} */
  #subscription = null;

  /** @param {ReactiveControllerHost} host @param {{[K in keyof Changes]?: (change: Changes[K]) => void}} handlers */
  constructor(host, handlers) {
    this.handlers = handlers;
    host.addController(this);
  }

  hostConnected() {
    this.#subscription = new AbortController();
    for (const [kind, handle] of Object.entries(this.handlers)) {
      const take = /** @type {(change: unknown) => void} */ (handle);
      const listener = (/** @type {Event} */ event) => take(/** @type {CustomEvent} */ (event).detail);
      feed.addEventListener(kind, listener, { signal: this.#subscription.signal });
    }
  }

  hostDisconnected() {
    this.#subscription?.abort();
  }
}
