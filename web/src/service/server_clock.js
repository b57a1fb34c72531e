/**
 * The service's time. In a demonstration it runs faster than the machine's, at a speed that changes, so it is asked for
 * again and again and drawn on from the last two answers.
 */
import * as api from "./api.js";

const ASK_AGAIN_MS = { simulated: 4_000, real: 600_000 };
const SHORTEST_BASE_MS = 500;

/** Draws a line through what it was told. All values in milliseconds. */
export class ServerClock {
  /** @param {() => number} machine_ms */
  constructor(machine_ms = () => performance.now()) {
    this.machine_ms = machine_ms;
    this.speed = 1;
    this.machineAtLast = machine_ms();
    this.serverAtLast = Date.now();
    this.told = false;
  }

  /** @param {number} server_ms */
  tell(server_ms) {
    const machine_ms = this.machine_ms();
    const base_ms = machine_ms - this.machineAtLast;
    if (this.told && base_ms > SHORTEST_BASE_MS) this.speed = Math.max(0, (server_ms - this.serverAtLast) / base_ms);
    if (this.told && base_ms <= SHORTEST_BASE_MS) return;
    [this.machineAtLast, this.serverAtLast, this.told] = [machine_ms, server_ms, true];
  }

  now() {
    return this.serverAtLast + (this.machine_ms() - this.machineAtLast) * this.speed;
  }
}

const clock = new ServerClock();

/** The service's present moment, in milliseconds since 1970. */
export const serverNow = () => clock.now();

/** @param {string} now as the service says it */
export const tellServerTime = (now) => clock.tell(Date.parse(now));

/** @param {{now: string, simulated: boolean}} about */
export function keepServerTime(about) {
  tellServerTime(about.now);
  const askAgain = () => api.about().then(({ now }) => tellServerTime(now), () => undefined);
  setInterval(askAgain, about.simulated ? ASK_AGAIN_MS.simulated : ASK_AGAIN_MS.real);
  if (about.simulated) setTimeout(askAgain, 2 * SHORTEST_BASE_MS);
  // A sleeping machine's stop-watch stands still.
  document.addEventListener("visibilitychange", () => document.hidden || askAgain());
}
