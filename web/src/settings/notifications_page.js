/** The inbox: what I was told, unread first to the eye, each leading to its letter. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { pageOf } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { ago } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Inbox, NotificationView } from "../../types/api_types.ts" */

export class NotificationsPage extends PageElement {
  /** A count of changes made on this page. */
  #reads = 0;

  static properties = { inbox: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {Inbox | null} */
    this.inbox = null;
    this.problem = "";
    new Ticking(this, 5_000);
    new OnLive(this, { notice: () => this.#fetch(), resync: () => this.#fetch() });
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const unread = this.inbox?.items.filter(({ read }) => !read) ?? [];
    return html`<div class="title-line">
        <h1>${t("notices.title")}</h1>
        ${unread.length ? html`<button class="quiet" @click=${() => this.#read(unread)}>${t("notices.all_read")}</button>` : nothing}
      </div>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${this.inbox ? this.#list(this.inbox.items) : nothing}`;
  }

  /** The shell counts what is unread. @param {Map<string, unknown>} changed */
  updated(changed) {
    if (this.inbox && changed.has("inbox")) this.dispatchEvent(new CustomEvent("inbox", { bubbles: true, detail: this.inbox }));
  }

  /** @param {NotificationView[]} notices */
  #list(notices) {
    if (!notices.length) return html`<p class="empty">${t("notices.none")}</p>`;
    return html`<ul class="notices">
      ${notices.map(
        (notice) => html`<li class=${notice.read ? "" : "new"}>
          <a href=${pageOf(notice) ?? nothing} @click=${() => this.#read([notice])}>
            <strong><bdi>${notice.title}</bdi>${notice.read ? nothing : html` <span class="unseen">(${t("notices.unread")})</span>`}</strong>
            <bdi>${notice.body}</bdi>
            <time datetime=${notice.at}>${ago(notice.at, serverNow())}</time>
          </a>
        </li>`,
      )}
    </ul>`;
  }

  /** @param {NotificationView[]} notices */
  async #read(notices) {
    const ids = notices.filter(({ read }) => !read).map(({ id }) => id);
    if (!ids.length) return;
    await this.#attempt(async () => {
      await api.markRead(ids);
      this.#reads += 1;
      if (this.inbox) this.inbox = withRead(this.inbox, ids);
    });
  }

  /** @returns {Promise<void>} */
  #fetch() {
    return this.#attempt(async () => {
      const reads = this.#reads;
      const inbox = await api.notices();
      if (reads !== this.#reads) return this.#fetch(); // the answer may be older than what was read meanwhile
      this.inbox = inbox;
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

/** @param {Inbox} inbox @param {NotificationView["id"][]} ids @returns {Inbox} */
function withRead(inbox, ids) {
  const items = inbox.items.map((notice) => (ids.includes(notice.id) ? { ...notice, read: true } : notice));
  return { ...inbox, items, unread: inbox.unread - ids.length };
}

customElements.define("notifications-page", NotificationsPage);
