/**
 * Which robot holds which corridor, and what each reports to be in, as far as this person may see it: fetched, then as it changes.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { OccupiedCorridor, ReportedPlace, RobotTraffic } from "../../types/api_types.ts"
 */
import * as api from "../service/api.js";
import { OnLive } from "./live.js";

/** @implements {ReactiveController} */
export class TrafficNow {
  /** @type {readonly OccupiedCorridor[]} */
  taken = [];
  /** @type {readonly ReportedPlace[]} */
  reported = [];
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
    this.#show(answer.taken, answer.reported);
  }

  /** @param {RobotTraffic} news */
  #hear({ robot, taken, reported }) {
    this.#heard += 1;
    const ofOthers = (/** @type {{robot: string}} */ one) => one.robot !== robot;
    this.#show([...this.taken.filter(ofOthers), ...taken], [...this.reported.filter(ofOthers), ...(reported ? [reported] : [])]);
  }

  /** @param {readonly OccupiedCorridor[]} taken @param {readonly ReportedPlace[]} reported */
  #show(taken, reported) {
    [this.taken, this.reported] = [taken, reported];
    this.host.requestUpdate();
  }
}
