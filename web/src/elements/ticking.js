/** Draws an element again every so often, for texts like "2 min ago". @import { ReactiveController, ReactiveControllerHost } from "lit" */

/** @implements {ReactiveController} */
export class Ticking {
  #timer = 0;

  /** @param {ReactiveControllerHost} host @param {number} [every_ms] */
  constructor(host, every_ms = 1_000) {
    this.host = host;
    this.every_ms = every_ms;
    host.addController(this);
  }

  hostConnected() {
    this.#timer = setInterval(() => document.hidden || this.host.requestUpdate(), this.every_ms);
  }

  hostDisconnected() {
    clearInterval(this.#timer);
  }
}
