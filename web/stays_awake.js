/** Keeps a screen that hangs on a wall from going dark, where the browser can. @import { ReactiveController, ReactiveControllerHost } from "lit" */

/** @implements {ReactiveController} */
export class StaysAwake {
  /** @type {WakeLockSentinel | null} */
  #lock = null;
  #whenSeen = () => void this.#hold();

  /** @param {ReactiveControllerHost} host */
  constructor(host) {
    host.addController(this);
  }

  hostConnected() {
    // A lock ends when the page is hidden.
    document.addEventListener("visibilitychange", this.#whenSeen);
    this.#hold();
  }

  hostDisconnected() {
    document.removeEventListener("visibilitychange", this.#whenSeen);
    this.#lock?.release();
  }

  async #hold() {
    if (document.hidden || !("wakeLock" in navigator)) return;
    // Refused on a nearly empty battery: then the screen goes dark as it would anyway.
    this.#lock = await navigator.wakeLock.request("screen").catch(() => null);
  }
}
