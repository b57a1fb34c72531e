/** Whom I have named to meet the robot in my place, for letters that are still under way; each taken back here too. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { followPage } from "../service/links.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { isolated, t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { address } from "../elements/address.js";
import { SettingsPart, remark } from "./settings_part.js";
/** @import { CampusMap, MyDelegate } from "../../types/api_types.ts" */

const AT_ONCE = 20;

export class MyDelegates extends SettingsPart {
  static properties = { map: { attribute: false }, items: { state: true }, next: { state: true } };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {MyDelegate[] | null} */
    this.items = null;
    /** @type {string | null} */
    this.next = null;
  }

  firstUpdated() {
    this.attempt(() => this.#more());
  }

  render() {
    const { map, items } = this;
    if (!map || !(items ?? this.problem)) return nothing;
    return this.card(
      "delegates",
      html`${items?.length ? html`<ul class="rows">${items.map((one) => this.#row(one, map))}</ul>` : nothing}
        ${items?.length === 0 ? noneYet() : nothing}
        ${this.next ? html`<button class="quiet" @click=${() => this.attempt(() => this.#more())}>${t("mail.more")}</button>` : nothing}`,
    );
  }

  /** @param {MyDelegate} one @param {CampusMap} map */
  #row(one, map) {
    const { name, email, purpose, post, order_id, expires_at } = one;
    const [what, until] = [letter(one), t("code.expires", { time: dayAndTime(expires_at, serverNow()) })];
    return html`<li>
      <span>
        <strong><bdi>${name}</bdi></strong>${email ? address(email) : nothing}
        ${remark("", html`<a href=${followPage(order_id)}>${what}</a>`)}
        ${remark(t(`settings.delegates.${purpose}`, { post: titleOf(map, post) }), until)}
      </span>
      <button class="quiet danger" aria-label="${t("delegate.revoke")}, ${isolated(name)}, ${what}" @click=${() => this.#revoke(one)}>${t("delegate.revoke")}</button>
    </li>`;
  }

  /** @param {MyDelegate} one */
  #revoke({ id, name, order_id }) {
    return this.attempt(async () => {
      await api.revokeDelegate(order_id, id);
      this.items = this.items?.filter((other) => other.id !== id) ?? null;
    }, t("settings.delegates.revoked", { name }));
  }

  async #more() {
    const page = await api.myDelegates({ limit: AT_ONCE, cursor: this.next ?? undefined });
    [this.items, this.next] = [[...(this.items ?? []), ...page.items], page.next];
  }
}

/** The contents, sender and recipient of a letter. @param {MyDelegate} one */
function letter({ description, my_role, sender, recipient }) {
  const other = my_role === "recipient" ? t("mail.from", { name: sender.name }) : t("mail.to", { name: recipient.name });
  return description ? `${isolated(description)} · ${other}` : other;
}

const noneYet = () =>
  html`<p class="empty">${t("settings.delegates.none", { action: t("delegate.open") })} <a href="/mail.html">${t("nav.mail")}</a></p>`;

customElements.define("my-delegates", MyDelegates);
