/** My name, the language of pages and notifications, and the post where I usually am. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { speak } from "../texts/language.js";
import { t } from "../texts/texts.js";
import { field } from "../elements/field.js";
import { SettingsPart } from "./settings_part.js";
/** @import { AboutMe, CampusMap, Person } from "../../types/api_types.ts" */
/** @typedef {HTMLInputElement | HTMLSelectElement} Changed */

// Each in its own language: a reader may know no other.
const LANGUAGES = { en: "English", fr: "Français" };

export class MyProfile extends SettingsPart {
  /** A change that could not be saved. @type {Changed | null} */
  #unsaved = null;

  static properties = { person: { attribute: false }, map: { attribute: false } };

  constructor() {
    super();
    /** @type {Person | null} */
    this.person = null;
    /** @type {CampusMap | null} */
    this.map = null;
  }

  render() {
    const { person, map } = this;
    if (!person || !map) return html``;
    return this.card(
      "profile",
      html`<form @submit=${(/** @type {Event} */ event) => event.preventDefault()} @change=${(/** @type {Event} */ { target }) => this.#change(/** @type {Changed} */ (target))}>
        ${field({ name: "name", label: t("settings.name"), hint: t("settings.name_hint") }, ({ id, describedBy }) => html`<input id=${id} name="name"
          autocomplete="name" dir="auto" maxlength="80" required .value=${person.name} aria-describedby=${describedBy} />`)}
        <div class="pair">
          ${field({ name: "language", label: t("settings.language") }, ({ id }) => html`<select id=${id} name="language">
            ${Object.entries(LANGUAGES).map(([tag, name]) => html`<option value=${tag} lang=${tag} .selected=${tag === person.language}>${name}</option>`)}
          </select>`)}
          ${field({ name: "usual_post", label: t("settings.usual_post") }, ({ id }) => html`<select id=${id} name="usual_post">
            <option value="" .selected=${!person.usual_post}>${t("settings.no_post")}</option>
            ${map.posts.map(({ name, title }) => html`<option value=${name} .selected=${name === person.usual_post}>${title}</option>`)}
          </select>`)}
        </div>
        ${this.#unsaved ? html`<button type="button" @click=${this.#again}>${t("settings.save")}</button>` : nothing}
      </form>`,
    );
  }

  #again() {
    if (this.#unsaved) this.#change(this.#unsaved);
  }

  /** @param {Changed} target */
  async #change(target) {
    const { name, value } = target;
    const text = value.trim();
    if (name === "name" && !text) return void (this.problem = t("settings.name_missing"));
    const changes = /** @type {AboutMe} */ ({ [name]: name === "usual_post" ? text || null : text });
    const isSaved = await this.attempt(async () => (this.person = await api.changeMe(changes)));
    this.#unsaved = isSaved ? null : target;
    this.requestUpdate();
    if (this.problem || !this.person) return;
    if (name === "language") await this.#speak(this.person.language);
    this.said = t("settings.saved");
    this.dispatchEvent(new CustomEvent("me", { detail: this.person, bubbles: true }));
  }

  /** @param {string} language */
  async #speak(language) {
    await speak(language);
    document.title = `${t("title.settings")} · ${t("app.name")}`;
  }
}

customElements.define("my-profile", MyProfile);
