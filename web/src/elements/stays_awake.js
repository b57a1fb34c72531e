/** Keeps an untouched screen from going dark, where the browser can. @import { ReactiveController, ReactiveControllerHost } from "lit" */

/** @implements {ReactiveController} */
export class StaysAwake {
  /** @type {Promise<WakeLockSentinel | null> | null} */
  #lock = null;
  #isConnected = false;
  #whenSeen = () => this.#settle();

  /** @param {ReactiveControllerHost} host @param {() => boolean} [isNeeded] looked at whenever the host has been drawn */
  constructor(host, isNeeded = () => true) {
    this.isNeeded = isNeeded;
    host.addController(this);
  }

  hostConnected() {
    this.#isConnected = true;
    // A browser ends the lock of a page that is hidden: take it again when the page is back.
    document.addEventListener("visibilitychange", this.#whenSeen);
    this.#settle();
  }

  hostUpdated() {
    this.#settle();
  }

  hostDisconnected() {
    this.#isConnected = false;
    document.removeEventListener("visibilitychange", this.#whenSeen);
    this.#settle();
  }

  #settle() {
    const isWanted = this.#isConnected && !document.hidden && this.isNeeded();
    if (isWanted && !this.#lock) this.#lock = this.#ask();
    if (isWanted || !this.#lock) return;
    this.#lock.then((lock) => lock?.release());
    this.#lock = null;
  }

  /** Refused on a nearly empty battery: then the screen goes dark as it would anyway. @returns {Promise<WakeLockSentinel | null>} */
  async #ask() {
    return "wakeLock" in navigator ? navigator.wakeLock.request("screen").catch(() => null) : null;
  }
}
