/** Which notices come where: a row for each kind, a column for each channel. The page's own list has them all. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { SettingsPart } from "./settings_part.js";
/** @import { NoticeWishes, Person } from "../../types/api_types.ts" */
/** @typedef {keyof NoticeWishes["muted"]} Channel @typedef {NoticeWishes["kinds"][number]} Kind */

const FOR_THOSE_ON_DUTY = "alarm";

export class NoticeTable extends SettingsPart {
  static properties = { wishes: { attribute: false }, person: { attribute: false } };

  constructor() {
    super();
    /** @type {NoticeWishes | null} */
    this.wishes = null;
    /** @type {Person | null} */
    this.person = null;
  }

  render() {
    const { wishes } = this;
    if (!wishes) return nothing;
    const channels = /** @type {Channel[]} */ (wishes.webhook ? ["mail", "push", "webhook"] : ["mail", "push"]);
    return this.card(
      "notices",
      html`<table class="wishes">
        <thead>
          <tr>
            <td></td>
            ${channels.map((channel) => html`<th scope="col">${t(`settings.channel.${channel}`)}</th>`)}
          </tr>
        </thead>
        <tbody>
          ${this.#kinds(wishes).map(
            (kind) => html`<tr>
              <th scope="row">
                ${t(`settings.kind.${kind}`)}${wishes.must_reach.includes(kind) ? html`<span class="remark">${t("settings.must_reach")}</span>` : nothing}
              </th>
              ${channels.map((channel) => html`<td>${this.#box(wishes, kind, channel)}</td>`)}
            </tr>`,
          )}
        </tbody>
      </table>`,
    );
  }

  /** @param {NoticeWishes} wishes */
  #kinds({ kinds }) {
    const isOnDuty = this.person?.roles.some((role) => role !== "member");
    return kinds.filter((kind) => isOnDuty || kind !== FOR_THOSE_ON_DUTY);
  }

  /** @param {NoticeWishes} wishes @param {Kind} kind @param {Channel} channel */
  #box({ muted }, kind, channel) {
    return html`<input type="checkbox" class="tick" aria-label="${t(`settings.kind.${kind}`)}, ${t(`settings.channel.${channel}`)}"
      .checked=${!muted[channel].includes(kind)}
      @change=${(/** @type {Event} */ event) => this.#wish(kind, channel, /** @type {HTMLInputElement} */ (event.target))} />`;
  }

  /** @param {Kind} kind @param {Channel} channel @param {HTMLInputElement} box */
  async #wish(kind, channel, box) {
    const before = this.wishes?.muted[channel] ?? [];
    const muted = box.checked ? before.filter((one) => one !== kind) : [...before, kind];
    [this.problem, this.said] = ["", ""];
    try {
      const wishes = await api.changeNoticeWishes(/** @type {NoticeWishes["muted"]} */ ({ [channel]: muted }));
      this.said = t("settings.saved");
      this.dispatchEvent(new CustomEvent("wishes", { detail: wishes, bubbles: true }));
    } catch (failure) {
      box.checked = !box.checked;
      this.problem = inWords(failure);
    }
  }
}

customElements.define("notice-table", NoticeTable);
