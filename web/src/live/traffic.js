/**
 * Which robot holds which corridor, as far as this person may see it: fetched, then as it changes.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { RobotTraffic, OccupiedCorridor } from "../../types/api_types.ts"
 */
import * as api from "../service/api.js";
import { OnLive } from "./live.js";

/** @implements {ReactiveController} */
export class TrafficNow {
  /** @type {readonly OccupiedCorridor[]} */
  taken = [];
  /** A count of received events. */
  #heard = 0;

  /** @param {ReactiveControllerHost} host drawn again with each change */
  constructor(host) {
    this.host = host;
    host.addController(this);
    new OnLive(host, {
      traffic: (news) => this.#hear(news),
      resync: () => this.fetch(),
    });
  }

  hostConnected() {
    this.fetch();
  }

  /** Anew, as when another robot is on my order. What is known stays if there is no answer. @returns {Promise<void>} */
  async fetch() {
    const heard = this.#heard;
    const answer = await api.traffic().catch(() => null);
    if (!answer) return;
    if (heard !== this.#heard) return this.fetch(); // the answer may be older than what was heard meanwhile
    this.#show(answer.taken);
  }

  /** @param {RobotTraffic} news */
  #hear({ robot, taken }) {
    this.#heard += 1;
    this.#show([...this.taken.filter((one) => one.robot !== robot), ...taken]);
  }

  /** @param {readonly OccupiedCorridor[]} taken */
  #show(taken) {
    this.taken = taken;
    this.host.requestUpdate();
  }
}
