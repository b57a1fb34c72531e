/** The settings: one card for each thing that can be settled; each saves by itself. */
import { html } from "lit";
import * as api from "../service/api.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import "./my_contacts.js";
import "./my_delegates.js";
import "./my_devices.js";
import "./my_profile.js";
import "./my_sessions.js";
import "./my_tokens.js";
import "./my_webhook.js";
import "./notification_table.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, NotificationPreferences, Person } from "../../types/api_types.ts" */

const PARTS = ["profile", "notices", "devices", "contacts", "delegates", "sessions", "webhook", "tokens"];

export class SettingsPage extends PageElement {
  static properties = { person: { attribute: false }, map: { state: true }, preferences: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {Person | null} */
    this.person = null;
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {NotificationPreferences | null} */
    this.preferences = null;
    this.problem = "";
    this.addEventListener("preferences", (event) => (this.preferences = /** @type {CustomEvent} */ (event).detail));
    this.addEventListener("me", (event) => (this.person = /** @type {CustomEvent} */ (event).detail));
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const { person, map, preferences } = this;
    if (!map || !preferences) return this.problem ? html`<h1>${t("title.settings")}</h1>${problemLine(this.problem)}` : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    return html`<h1>${t("title.settings")}</h1>
      <div class="settings">
        <nav class="contents" aria-label=${t("settings.contents")}>
          ${PARTS.map((part) => html`<a href="#${part}">${t(`settings.${part}.title`)}</a>`)}
        </nav>
        <div class="parts">
          <my-profile .person=${person} .map=${map}></my-profile>
          <notification-table .person=${person} .preferences=${preferences}></notification-table>
          <my-devices .person=${person} .preferences=${preferences}></my-devices>
          <my-contacts .map=${map}></my-contacts>
          <my-delegates .map=${map}></my-delegates>
          <my-sessions></my-sessions>
          <my-webhook .preferences=${preferences}></my-webhook>
          <my-tokens .person=${person}></my-tokens>
        </div>
      </div>`;
  }

  async #fetch() {
    try {
      [this.map, this.preferences] = await Promise.all([loadMap(), api.notificationPreferences()]);
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("settings-page", SettingsPage);
