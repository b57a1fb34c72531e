/** My address book: those I saved and those I exchanged mail with; changed, added, forgotten. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { looksLikeEmail } from "../session/email.js";
import { titleOf } from "../service/posts.js";
import { t } from "../texts/texts.js";
import { address } from "../elements/address.js";
import { field } from "../elements/field.js";
import { SettingsPart } from "./settings_part.js";
/** @import { CampusMap, Contact } from "../../types/api_types.ts" */

const AT_ONCE = 20;

export class MyContacts extends SettingsPart {
  static properties = { map: { attribute: false }, items: { state: true }, next: { state: true }, edited: { state: true } };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Contact[] | null} */
    this.items = null;
    /** @type {string | null} */
    this.next = null;
    /** Whom the form is about; null for a new contact. @type {Contact | null} */
    this.edited = null;
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const { map, items } = this;
    if (!map || !items) return nothing;
    return this.card(
      "contacts",
      html`<ul class="rows">${items.map((one) => this.#row(one, map))}</ul>
        ${items.length ? nothing : html`<p class="empty">${t("settings.no_contacts")}</p>`}
        ${this.next ? html`<button class="quiet" @click=${() => this.#more()}>${t("mail.more")}</button>` : nothing}
        ${this.#form(map)}`,
    );
  }

  /** @param {Contact} one @param {CampusMap} map */
  #row(one, map) {
    const name = one.label || one.name || one.email;
    return html`<li>
      <span><strong><bdi>${name}</bdi></strong>${address(one.email, one.post ? ` · ${titleOf(map, one.post)}` : "")}</span>
      <span class="does">
        <button class="quiet" aria-label="${t(one.saved ? "settings.change" : "settings.save")}, ${name}" @click=${() => this.#edit(one)}>
          ${t(one.saved ? "settings.change" : "settings.save")}
        </button>
        ${one.saved
          ? html`<button class="quiet danger" aria-label="${t("settings.forget")}, ${name}" @click=${() => this.#forget(one)}>${t("settings.forget")}</button>`
          : nothing}
      </span>
    </li>`;
  }

  /** @param {CampusMap} map */
  #form(map) {
    const { edited } = this;
    return html`<form novalidate @submit=${this.#save}>
      <h3>${edited ? t("settings.change_one", { name: edited.label || edited.name || edited.email }) : t("settings.add")}</h3>
      ${field({ name: "contact_email", label: t("settings.contact_email") }, ({ id }) => html`<input id=${id} name="contact_email" type="email"
        autocomplete="off" required ?readonly=${edited !== null} .value=${edited?.email ?? ""} />`)}
      <div class="pair">
        ${field({ name: "label", label: t("settings.label"), optional: true }, ({ id }) => html`<input id=${id} name="label" dir="auto" maxlength="80"
          autocomplete="off" .value=${edited?.label || edited?.name || ""} />`)}
        ${field({ name: "post", label: t("settings.their_post"), optional: true }, ({ id }) => html`<select id=${id} name="post">
          <option value="" .selected=${!edited?.post}>${t("settings.no_post")}</option>
          ${map.posts.map(({ name, title }) => html`<option value=${name} .selected=${name === edited?.post}>${title}</option>`)}
        </select>`)}
      </div>
      <div class="choices">
        <button ?disabled=${this.busy}>${t("settings.save")}</button>
        ${edited ? html`<button type="button" class="quiet" @click=${() => (this.edited = null)}>${t("settings.leave")}</button>` : nothing}
      </div>
    </form>`;
  }

  /** @param {Contact} one */
  #edit(one) {
    this.edited = one;
    this.focusOn("[name=label]");
  }

  /** @param {SubmitEvent} event */
  async #save(event) {
    event.preventDefault();
    const form = /** @type {HTMLFormElement} */ (event.target);
    const written = new FormData(form);
    const email = `${written.get("contact_email")}`.trim();
    if (!looksLikeEmail(email)) return void (this.problem = t("error.malformed.email"));
    const request = { label: `${written.get("label")}`.trim(), post: `${written.get("post")}` || null };
    if (!(await this.attempt(() => api.saveContact(email, request), t("settings.saved")))) return;
    this.edited = null;
    form.reset();
    await this.#fetch();
  }

  /** @param {Contact} one */
  async #forget(one) {
    if (await this.attempt(() => api.forgetContact(one.email), t("settings.forgotten"))) await this.#fetch();
  }

  async #fetch() {
    const page = await api.contacts({ limit: AT_ONCE }).catch(() => ({ items: [], next: null }));
    [this.items, this.next] = [page.items, page.next];
  }

  async #more() {
    const page = await api.contacts({ limit: AT_ONCE, cursor: this.next ?? undefined });
    [this.items, this.next] = [[...(this.items ?? []), ...page.items], page.next];
  }
}

customElements.define("my-contacts", MyContacts);
