/**
 * Brings where an order stands into view once a tap has changed it: who tapped has scrolled down to their code.
 * @import { ReactiveController } from "lit"
 * @import { Order } from "../../types/api_types.ts"
 * @import { PageElement } from "../elements/page_element.js"
 */

const ASKED = "robot-asked";

/** Told by an element before it asks: the answer may come after what it did. */
export const robotAsked = () => new Event(ASKED, { bubbles: true });

/** @implements {ReactiveController} */
export class ShowsOutcome {
  /** The state in which the robot was asked. @type {Order["state"] | undefined} */
  #askedIn;

  /** @param {PageElement & {order: Order | null}} host */
  constructor(host) {
    this.host = host;
    host.addController(this);
    host.addEventListener(ASKED, () => (this.#askedIn = host.order?.state));
  }

  hostUpdated() {
    if (!this.#askedIn || this.host.order?.state === this.#askedIn) return;
    this.#askedIn = undefined;
    this.host.querySelector(".standing")?.scrollIntoView({ block: "center" });
  }
}
