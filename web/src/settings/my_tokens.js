/** Tokens for scripts of mine: made with what they may do, shown once, revoked. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { field } from "../elements/field.js";
import { SettingsPart, remark } from "./settings_part.js";
import { shownOnce } from "./shown_once.js";
/** @import { NewToken, Person, Token } from "../../types/api_types.ts" */

const EVERYBODYS = /** @type {NewToken["scopes"]} */ ([
  "orders:read", "orders:write", "robots:read", "notices:read", "notices:write", "contacts:read", "live:read",
]);
const OF_ROLES = /** @type {const} */ ({ dispatcher: "dispatch", maintainer: "maintain" });
const DAYS = [30, 90, 366];

export class MyTokens extends SettingsPart {
  static properties = { person: { attribute: false }, items: { state: true }, made: { state: true } };

  constructor() {
    super();
    /** @type {Person | null} */
    this.person = null;
    /** @type {Token[] | null} */
    this.items = null;
    this.made = "";
  }

  firstUpdated() {
    this.attempt(() => this.#fetch());
  }

  render() {
    if (!this.items) return nothing;
    return this.card(
      "tokens",
      html`${this.items.length ? html`<ul class="rows">${this.items.map((one) => this.#row(one))}</ul>` : nothing}
        ${this.made ? shownOnce("made-token", t("settings.token"), this.made) : nothing} ${this.#form()}`,
    );
  }

  /** @param {Token} one */
  #row({ prefix, name, scopes, expires_at, used_at }) {
    const until = t("settings.until", { time: dayAndTime(expires_at, serverNow()) });
    const used = used_at ? t("settings.used", { time: dayAndTime(used_at, serverNow()) }) : t("settings.never_used");
    return html`<li>
      <span><strong><bdi>${name}</bdi></strong> <code>cmp_${prefix}…</code>${remark(scopes.join(", "), "")}${remark(until, `· ${used}`)}</span>
      <button class="quiet danger" aria-label="${t("settings.revoke")}, ${name}" @click=${() => this.#revoke(prefix)}>${t("settings.revoke")}</button>
    </li>`;
  }

  #form() {
    return html`<form novalidate @submit=${this.#make}>
      <h3>${t("settings.new_token")}</h3>
      ${field({ name: "token_name", label: t("settings.token_name") }, ({ id }) => html`<input id=${id} name="token_name" maxlength="80" required autocomplete="off" />`)}
      <fieldset class="ticks">
        <legend>${t("settings.scopes")}</legend>
        ${this.#scopes().map(
          (scope) => html`<label><input type="checkbox" class="tick" name="scope" value=${scope} /><span>${t(`settings.scope.${scope.replace(":", "_")}`)}</span></label>`,
        )}
      </fieldset>
      ${field({ name: "days", label: t("settings.days") }, ({ id }) => html`<select id=${id} name="days">
        ${DAYS.map((days) => html`<option value=${days} .selected=${days === 90}>${t("settings.days_count", { days })}</option>`)}
      </select>`)}
      <button ?disabled=${this.busy}>${t("settings.make_token")}</button>
    </form>`;
  }

  /** Scopes that a token can have: never more than its owner's permissions. */
  #scopes() {
    const ofRoles = Object.entries(OF_ROLES).filter(([role]) => this.person?.roles.some((one) => one === role));
    return [...EVERYBODYS, ...ofRoles.map(([, scope]) => scope)];
  }

  /** @param {SubmitEvent} event */
  async #make(event) {
    event.preventDefault();
    const form = /** @type {HTMLFormElement} */ (event.target);
    const written = new FormData(form);
    const name = `${written.get("token_name")}`.trim();
    const scopes = /** @type {NewToken["scopes"]} */ (written.getAll("scope").map(String));
    if (!name || !scopes.length) return void (this.problem = t(name ? "settings.scopes_missing" : "settings.token_name_missing"));
    const request = { name, scopes, days: Number(written.get("days")) };
    const make = async () => {
      this.made = (await api.makeToken(request)).token;
      await this.#fetch();
    };
    if (await this.attempt(make, t("settings.token_made"))) form.reset();
  }

  /** @param {string} prefix */
  #revoke(prefix) {
    return this.attempt(async () => {
      await api.revokeToken(prefix);
      this.made = "";
      await this.#fetch();
    }, t("settings.revoked"));
  }

  async #fetch() {
    this.items = (await api.tokens()).items;
  }
}

customElements.define("my-tokens", MyTokens);
