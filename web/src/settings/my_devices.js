/** The devices that show notifications by themselves: this one switched on and off, others taken off the list. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { SettingsPart, remark } from "./settings_part.js";
/** @import { NotificationPreferences, Person } from "../../types/api_types.ts" */

export class MyDevices extends SettingsPart {
  /** @type {typeof import("../offline/push.js") | null} */
  #push = null;

  static properties = { preferences: { attribute: false }, person: { attribute: false }, here: { state: true } };

  constructor() {
    super();
    /** @type {NotificationPreferences | null} */
    this.preferences = null;
    /** @type {Person | null} */
    this.person = null;
    /** @type {import("../offline/push.js").PushState | null} */
    this.here = null;
  }

  async firstUpdated() {
    this.#push = await import("../offline/push.js");
    this.here = await this.#push.pushState();
  }

  render() {
    if (!this.preferences) return nothing;
    const { devices } = this.preferences;
    return this.card(
      "devices",
      html`${this.#thisDevice()}
        ${devices.length
          ? html`<ul class="rows">
              ${devices.map(
                ({ id, push_service, created_at }) => html`<li>
                  <span><strong>${push_service}</strong>${remark(t("settings.since"), dayAndTime(created_at, serverNow()))}</span>
                  <button class="quiet danger" aria-label="${t("settings.remove")}, ${push_service}" @click=${() => this.#remove(id)}>${t("settings.remove")}</button>
                </li>`,
              )}
            </ul>`
          : nothing}`,
    );
  }

  #thisDevice() {
    const { here } = this;
    if (!here || !this.#push) return html`<p class="room"></p>`;
    return html`<p class="room">${this.#push.pushWords(here)}</p>
      ${here === "off" ? html`<button class="main" ?disabled=${this.busy} @click=${this.#start}>${t("settings.push_on")}</button>` : nothing}
      ${here === "on" ? html`<button ?disabled=${this.busy} @click=${this.#end}>${t("settings.push_off")}</button>` : nothing}`;
  }

  #start() {
    return this.#switch(async (push) => push.startPush(this.person?.id ?? ""));
  }

  #end() {
    return this.#switch((push) => push.endPush());
  }

  /** @param {(push: typeof import("../offline/push.js")) => Promise<import("../offline/push.js").PushState>} turn */
  #switch(turn) {
    return this.attempt(async () => {
      if (this.#push) this.here = await turn(this.#push);
      this.#tell(await api.notificationPreferences());
    });
  }

  /** @param {string} id */
  #remove(id) {
    return this.attempt(async () => {
      await api.removeDevice(id);
      this.#tell(await api.notificationPreferences());
    }, t("settings.removed"));
  }

  /** @param {NotificationPreferences} preferences */
  #tell(preferences) {
    this.dispatchEvent(new CustomEvent("preferences", { detail: preferences, bubbles: true }));
  }
}

customElements.define("my-devices", MyDevices);
