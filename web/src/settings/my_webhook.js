/** An address of mine that is told of my notifications, and may be tried; the secret that signs them is shown once. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { field } from "../elements/field.js";
import { shownOnce } from "./shown_once.js";
import { SettingsPart, remark } from "./settings_part.js";
/** @import { NotificationPreferences, Trial } from "../../types/api_types.ts" */

export class MyWebhook extends SettingsPart {
  static properties = { preferences: { attribute: false }, secret: { state: true } };

  constructor() {
    super();
    /** @type {NotificationPreferences | null} */
    this.preferences = null;
    this.secret = "";
  }

  render() {
    if (!this.preferences) return nothing;
    const { webhook } = this.preferences;
    return this.card(
      "webhook",
      html`${webhook
          ? html`<ul class="rows"><li>
              <span><strong>${webhook.url}</strong>${remark(t("settings.since"), dayAndTime(webhook.created_at, serverNow()))}</span>
              <span class="does">
                <button class="quiet" aria-label="${t("settings.try")}, ${webhook.url}" ?disabled=${this.busy} @click=${this.#try}>${t("settings.try")}</button>
                <button class="quiet danger" aria-label="${t("settings.remove")}, ${webhook.url}" @click=${this.#remove}>${t("settings.remove")}</button>
              </span>
            </li></ul>`
          : nothing}
        ${this.secret ? shownOnce("webhook-secret", t("settings.secret"), this.secret) : nothing}
        <form novalidate @submit=${this.#set}>
          ${field({ name: "url", label: t(webhook ? "settings.url_other" : "settings.url") }, ({ id }) => html`<input id=${id} name="url" type="url"
            inputmode="url" autocomplete="off" required maxlength="1000" placeholder="https://" />`)}
          <button ?disabled=${this.busy}>${t("settings.url_set")}</button>
        </form>`,
    );
  }

  /** @param {SubmitEvent} event */
  async #set(event) {
    event.preventDefault();
    const input = /** @type {HTMLInputElement} */ (this.querySelector("[name=url]"));
    const url = input.value.trim();
    if (!url || input.validity.typeMismatch) return void (this.problem = t("settings.url_missing"));
    const done = await this.attempt(async () => (this.secret = (await api.setWebhook(url)).secret), t("settings.saved"));
    if (!done) return;
    input.value = "";
    this.#tell();
  }

  /** Its program may have the secret by now: what a notification would meet there is seen at once. */
  async #try() {
    /** @type {Trial | null} */
    let trial = null;
    const done = await this.attempt(async () => (trial = await api.tryWebhook()));
    if (done && trial) this.#say(trial);
  }

  /** @param {Trial} trial */
  #say({ is_good, status, problem }) {
    if (is_good) this.said = t("settings.tried", { status: `${status}` });
    else this.problem = status === null ? t("settings.tried_silent", { problem: problem ?? "" }) : t("settings.tried_refused", { status });
  }

  async #remove() {
    if (await this.attempt(api.removeWebhook, t("settings.removed"))) this.#tell();
    this.secret = "";
  }

  async #tell() {
    this.dispatchEvent(new CustomEvent("preferences", { detail: await api.notificationPreferences(), bubbles: true }));
  }
}

customElements.define("my-webhook", MyWebhook);
