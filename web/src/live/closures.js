/**
 * Into which corridors no robot is let: fetched, then as it changes.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { ClosedCorridor } from "../../types/api_types.ts"
 */
import * as api from "../service/api.js";
import { OnLive } from "./live.js";

/** @implements {ReactiveController} */
export class Closures {
  /** @type {readonly ClosedCorridor[]} */
  closed = [];
  /** A count of received events. */
  #heard = 0;

  /** @param {ReactiveControllerHost} host drawn again with each change */
  constructor(host) {
    this.host = host;
    host.addController(this);
    new OnLive(host, {
      closed: ({ closed }) => ((this.#heard += 1), this.show(closed)),
      resync: () => this.fetch(),
    });
  }

  hostConnected() {
    this.fetch();
  }

  /** Keep the known closures if there is no answer, or if a newer event has arrived. */
  async fetch() {
    const heard = this.#heard;
    const answer = await api.closedCorridors().catch(() => null);
    if (answer && heard === this.#heard) this.show(answer.closed);
  }

  /** @param {readonly ClosedCorridor[]} closed */
  show(closed) {
    this.closed = closed;
    this.host.requestUpdate();
  }
}
