/** The inbox: what I was told, unread first to the eye, each leading to its letter. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { pageOf } from "../links.js";
import { OnLive } from "../live.js";
import { inWords } from "../problems.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { Ticking } from "../ticking.js";
import { ago } from "../times.js";
import { problemLine } from "./field.js";
import { PageElement } from "./page_element.js";
/** @import { Notice } from "../api_types.ts" */

export class NoticesPage extends PageElement {
  /** How often some were read here. */
  #reads = 0;

  static properties = { notices: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {Notice[] | null} */
    this.notices = null;
    this.problem = "";
    new Ticking(this, 5_000);
    new OnLive(this, { notice: () => this.#fetch(), resync: () => this.#fetch() });
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const unread = this.notices?.filter(({ read }) => !read) ?? [];
    return html`<div class="title-line">
        <h1>${t("notices.title")}</h1>
        ${unread.length ? html`<button class="quiet" @click=${() => this.#read(unread)}>${t("notices.all_read")}</button>` : nothing}
      </div>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${this.notices === null ? nothing : this.#list(this.notices)}`;
  }

  /** @param {Notice[]} notices */
  #list(notices) {
    if (!notices.length) return html`<p class="empty">${t("notices.none")}</p>`;
    return html`<ul class="notices">
      ${notices.map(
        (notice) => html`<li class=${notice.read ? "" : "new"}>
          <a href=${pageOf(notice) ?? nothing} @click=${() => this.#read([notice])}>
            <strong>${notice.title}${notice.read ? nothing : html` <span class="unseen">(${t("notices.unread")})</span>`}</strong>
            <span>${notice.body}</span>
            <time datetime=${notice.at}>${ago(notice.at, serverNow())}</time>
          </a>
        </li>`,
      )}
    </ul>`;
  }

  /** @param {Notice[]} notices */
  async #read(notices) {
    const ids = notices.filter(({ read }) => !read).map(({ id }) => id);
    if (!ids.length) return;
    await this.#attempt(async () => {
      await api.markRead(ids);
      this.#reads += 1;
      this.notices = this.notices?.map((notice) => (ids.includes(notice.id) ? { ...notice, read: true } : notice)) ?? null;
      this.dispatchEvent(new CustomEvent("notices-read", { bubbles: true }));
    });
  }

  /** @returns {Promise<void>} */
  #fetch() {
    return this.#attempt(async () => {
      const reads = this.#reads;
      const { items } = await api.notices();
      if (reads !== this.#reads) return this.#fetch(); // the answer may be older than what was read meanwhile
      this.notices = items;
    });
  }

  /** @param {() => Promise<unknown>} attempt */
  async #attempt(attempt) {
    this.problem = "";
    try {
      await attempt();
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("notices-page", NoticesPage);
