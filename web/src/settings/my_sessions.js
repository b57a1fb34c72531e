/** Where I am signed in, and an end to it. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago } from "../texts/times.js";
import "../elements/ask_first.js";
import { SettingsPart, remark } from "./settings_part.js";
/** @import { OpenSession } from "../../types/api_types.ts" */

export class MySessions extends SettingsPart {
  static properties = { items: { state: true } };

  constructor() {
    super();
    /** @type {OpenSession[] | null} */
    this.items = null;
  }

  firstUpdated() {
    this.attempt(() => this.#fetch());
  }

  render() {
    if (!this.items) return nothing;
    return this.card(
      "sessions",
      html`<ul class="rows">${this.items.map((one) => this.#row(one))}</ul>
        ${this.items.length > 1 ? html`<ask-first .words=${othersWords()} .act=${api.endOtherSessions} @done=${this.#ended}></ask-first>` : nothing}`,
    );
  }

  /** @param {OpenSession} one */
  #row({ id, device, created_at, seen_at, current }) {
    const name = device || t("settings.some_device");
    const when = html`<time datetime=${seen_at ?? created_at}>${ago(seen_at ?? created_at, serverNow())}</time>`;
    return html`<li>
      <span><strong>${name}</strong>${remark(t("settings.seen"), when)}</span>
      ${current
        ? html`<span class="badge">${t("settings.this_one")}</span>`
        : html`<button class="quiet danger" aria-label="${t("settings.end")}, ${name}" @click=${() => this.#end(id)}>${t("settings.end")}</button>`}
    </li>`;
  }

  /** @param {number} id */
  #end(id) {
    return this.attempt(async () => {
      await api.endSession(id);
      await this.#fetch();
    }, t("settings.ended"));
  }

  #ended() {
    return this.attempt(() => this.#fetch(), t("settings.ended"));
  }

  async #fetch() {
    this.items = (await api.sessions()).items;
  }
}

const othersWords = () => ({
  open: t("settings.others.open"),
  title: t("settings.others.title"),
  body: t("settings.others.body"),
  yes: t("settings.others.yes"),
  no: t("settings.others.no"),
});

customElements.define("my-sessions", MySessions);
