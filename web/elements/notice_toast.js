/** What one is told just now, on whatever page one is, for as long as it takes to read and reach. */
import { html, nothing } from "lit";
import { orderFrom, pageOf } from "../links.js";
import { OnLive } from "../live.js";
import { t } from "../texts.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
/** @import { Notice } from "../api_types.ts" */

const SHOWN_MS = 12_000;

export class NoticeToast extends PageElement {
  static properties = { notice: { state: true } };

  #timer = 0;

  constructor() {
    super();
    /** @type {Notice | null} */
    this.notice = null;
    new OnLive(this, { notice: (notice) => this.#show(notice) });
  }

  render() {
    return html`<div role="status">${this.notice ? this.#toast(this.notice) : nothing}</div>`;
  }

  /** @param {Notice} notice */
  #toast(notice) {
    return html`<div class="toast">
      <a href=${pageOf(notice) ?? nothing}><strong>${notice.title}</strong><span>${notice.body}</span></a>
      <button class="quiet" aria-label=${t("notices.dismiss")} @click=${() => (this.notice = null)}>${icon("cross")}</button>
    </div>`;
  }

  /** Whoever looks at that very letter sees it happen already. @param {Notice} notice */
  #show(notice) {
    if (notice.order_id === orderFrom(location.search)) return;
    this.notice = notice;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => (this.notice = null), SHOWN_MS);
  }
}

customElements.define("notice-toast", NoticeToast);
