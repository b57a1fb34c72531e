/**
 * What changes, as it changes: one EventSource per page, shared by all elements on it.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { ClosedCorridors, Notice, Order, Robot, RobotTraffic, Watched } from "./api_types.ts"
 * @typedef {{order: Order, robot: Robot, traffic: RobotTraffic, closed: ClosedCorridors, notice: Notice, insight: Watched, connected: boolean}} Changes
 */
import * as api from "./api.js";

const OPEN_AGAIN_MS = 3_000;
const KINDS = /** @type {const} */ (["order", "robot", "traffic", "closed", "notice", "insight"]);

/** Tells `order`, `robot`, `traffic`, `closed` and `notice` as they come, and `connected` when the stream breaks (false) or has changes
 * to be fetched anew (true). */
export class LiveFeed extends EventTarget {
  #open = /** @type {() => EventSource} */ (api.openLive);
  /** @type {EventSource | null} */
  #source = null;

  start() {
    this.stop();
    const source = (this.#source = this.#open());
    for (const kind of KINDS) source.addEventListener(kind, (event) => this.#tell(kind, JSON.parse(event.data)));
    source.addEventListener("resync", () => this.#tell("connected", true));
    source.onopen = () => this.#tell("connected", true);
    source.onerror = () => this.#broken(source);
  }

  stop() {
    this.#source?.close();
    this.#source = null;
  }

  /** The browser opens a broken stream again by itself, but not one that was refused. @param {EventSource} source */
  #broken(source) {
    this.#tell("connected", false);
    if (source.readyState === EventSource.CLOSED && source === this.#source) {
      setTimeout(() => source === this.#source && this.start(), OPEN_AGAIN_MS);
    }
  }

  /** @param {keyof Changes} kind @param {unknown} detail */
  #tell(kind, detail) {
    this.dispatchEvent(new CustomEvent(kind, { detail }));
  }
}

const feed = new LiveFeed();

/** Open the page's stream, and keep none open behind a page that has been left. */
export function startLive() {
  feed.start();
  addEventListener("pagehide", () => feed.stop());
  addEventListener("pageshow", (event) => event.persisted && feed.start());
}

/** Nobody is signed in any more. */
export const stopLive = () => feed.stop();

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
      const listener = (/** @type {Event} */ event) => handle(/** @type {CustomEvent} */ (event).detail);
      feed.addEventListener(kind, listener, { signal: this.#subscription.signal });
    }
  }

  hostDisconnected() {
    this.#subscription?.abort();
  }
}
