/** Which notifications come where: a row for each kind, a column for each channel. The page's own list has them all. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { SettingsPart } from "./settings_part.js";
/** @import { NotificationPreferences, Person } from "../../types/api_types.ts" */
/** @typedef {keyof NotificationPreferences["muted"]} Channel @typedef {NotificationPreferences["kinds"][number]} Kind */

const FOR_THOSE_ON_DUTY = "alarm";

export class NotificationTable extends SettingsPart {
  static properties = { preferences: { attribute: false }, person: { attribute: false } };

  constructor() {
    super();
    /** @type {NotificationPreferences | null} */
    this.preferences = null;
    /** @type {Person | null} */
    this.person = null;
  }

  render() {
    const { preferences } = this;
    if (!preferences) return nothing;
    const channels = /** @type {Channel[]} */ (preferences.webhook ? ["mail", "push", "webhook"] : ["mail", "push"]);
    return this.card(
      "notices",
      html`<table class="preferences">
        <thead>
          <tr>
            <td></td>
            ${channels.map((channel) => html`<th scope="col">${t(`settings.channel.${channel}`)}</th>`)}
          </tr>
        </thead>
        <tbody>
          ${this.#kinds(preferences).map(
            (kind) => html`<tr>
              <th scope="row">
                ${t(`settings.kind.${kind}`)}${preferences.must_reach.includes(kind) ? html`<span class="remark">${t("settings.must_reach")}</span>` : nothing}
              </th>
              ${channels.map((channel) => html`<td>${this.#box(preferences, kind, channel)}</td>`)}
            </tr>`,
          )}
        </tbody>
      </table>`,
    );
  }

  /** @param {NotificationPreferences} preferences */
  #kinds({ kinds }) {
    const isOnDuty = this.person?.roles.some((role) => role !== "member");
    return kinds.filter((kind) => isOnDuty || kind !== FOR_THOSE_ON_DUTY);
  }

  /** @param {NotificationPreferences} preferences @param {Kind} kind @param {Channel} channel */
  #box({ muted }, kind, channel) {
    return html`<input type="checkbox" class="tick" aria-label="${t(`settings.kind.${kind}`)}, ${t(`settings.channel.${channel}`)}"
      .checked=${!muted[channel].includes(kind)}
      @change=${(/** @type {Event} */ event) => this.#change(kind, channel, /** @type {HTMLInputElement} */ (event.target))} />`;
  }

  /** @param {Kind} kind @param {Channel} channel @param {HTMLInputElement} box */
  async #change(kind, channel, box) {
    const before = this.preferences?.muted[channel] ?? [];
    const muted = box.checked ? before.filter((one) => one !== kind) : [...before, kind];
    [this.problem, this.said] = ["", ""];
    try {
      const preferences = await api.changeNotificationPreferences(/** @type {NotificationPreferences["muted"]} */ ({ [channel]: muted }));
      this.said = t("settings.saved");
      this.dispatchEvent(new CustomEvent("preferences", { detail: preferences, bubbles: true }));
    } catch (failure) {
      box.checked = !box.checked;
      this.problem = inWords(failure);
    }
  }
}

customElements.define("notification-table", NotificationTable);
