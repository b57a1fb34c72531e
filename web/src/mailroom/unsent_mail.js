/** Notifications that no channel has taken, with another try; and the mails that lie in the spool, to be read as text. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import * as api from "../service/api.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago, dayAndTime } from "../texts/times.js";
import { inParts } from "../elements/address.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Page, Sending, SpooledMail, SpooledText } from "../../types/api_types.ts" */

const AT_ONCE = 20;

export class UnsentMail extends PageElement {
  static properties = {
    waiting: { state: true },
    spool: { state: true },
    read: { state: true },
    said: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {Page<Sending> | null} null until it is known */
    this.waiting = null;
    /** @type {SpooledMail[]} */
    this.spool = [];
    /** @type {SpooledText | null} the mail that is being read */
    this.read = null;
    this.said = "";
    this.problem = "";
  }

  async open() {
    [this.read, this.said] = [null, ""];
    await this.updateComplete;
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).showModal();
    this.focusOn("#unsent-title");
    await this.#fetch();
  }

  render() {
    return html`<dialog class="ask wide" aria-labelledby="unsent-title">
      ${this.read ? this.#mail(this.read) : this.#lists()}
    </dialog>`;
  }

  #lists() {
    const { waiting } = this;
    if (!waiting) return html`<h2 id="unsent-title" tabindex="-1">${t("mailroom.unsent")}</h2>${this.problem ? problemLine(this.problem) : html`<p>${t("app.loading")}</p>`}`;
    return html`<h2 id="unsent-title" tabindex="-1">${t("mailroom.unsent")}</h2>
      <p role="status">${this.said}</p>
      ${this.problem ? problemLine(this.problem) : nothing}
      <h3>${t("mailroom.outbox")}</h3>
      ${waiting.items.length ? this.#outbox(waiting.items) : html`<p class="hint">${t("mailroom.outbox.none")}</p>`}
      ${waiting.next ? html`<button type="button" class="quiet" @click=${() => this.#more(waiting)}>${t("mailroom.more")}</button>` : nothing}
      <h3>${t("mailroom.spool")}</h3>
      <p class="hint">${t(this.spool.length ? "mailroom.spool.hint" : "mailroom.spool.none")}</p>
      <ul class="letters">
        ${this.spool.map((mail) => html`<li>
          <button type="button" class="letter" @click=${() => this.#open(mail)}>
            <strong><bdi>${mail.subject}</bdi></strong><span>${inParts(mail.to)}</span><small>${dayAndTime(mail.at, serverNow())}</small>
          </button>
        </li>`)}
      </ul>
      <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.close")}</button>`;
  }

  /** @param {Sending[]} sendings */
  #outbox(sendings) {
    return html`<ul class="letters">
      ${repeat(sendings, ({ id }) => id, (sending) => html`<li class="sending">
        <div>
          <strong>${inParts(sending.email)}</strong>
          <span>${t(`mailroom.channel.${sending.channel}`)} · ${t(sending.gave_up_at ? "mailroom.gave_up" : "mailroom.tries", { tries: sending.tries, ago: ago(sending.created_at, serverNow()) })}</span>
          ${sending.problem ? html`<small>${sending.problem}</small>` : nothing}
        </div>
        <button type="button" @click=${() => this.#retry(sending)}>${t("mailroom.retry")}<span class="unseen">: ${sending.email}</span></button>
      </li>`)}
    </ul>`;
  }

  /** Text alone: nothing in a mail is drawn or followed here. @param {SpooledText} mail */
  #mail({ subject, to, at, text, attachments }) {
    return html`<h2 id="unsent-title" tabindex="-1"><bdi>${subject}</bdi></h2>
      <p class="hint">${t("mailroom.mail_to", { to, time: dayAndTime(at, serverNow()) })}</p>
      <pre class="mail" tabindex="0" aria-labelledby="unsent-title">${text}</pre>
      ${attachments.length ? html`<p class="hint">${t("mailroom.attached", { names: attachments.join(", ") })}</p>` : nothing}
      <button type="button" @click=${this.#back}>${t("mailroom.back")}</button>`;
  }

  async #fetch() {
    await this.#attempt(async () => {
      const [waiting, spool] = await Promise.all([api.notSent({ limit: AT_ONCE }), api.spool()]);
      [this.waiting, this.spool] = [waiting, spool.items];
    });
  }

  /** @param {Page<Sending>} waiting */
  async #more({ items, next }) {
    await this.#attempt(async () => {
      const older = await api.notSent({ limit: AT_ONCE, cursor: next ?? undefined });
      this.waiting = { items: [...items, ...older.items], next: older.next };
    });
  }

  /** @param {Sending} sending */
  async #retry({ id, email }) {
    await this.#attempt(async () => {
      await api.sendAgain(id);
      this.said = t("mailroom.retried_to", { email });
    });
    await this.#fetch();
    this.focusOn("#unsent-title");
  }

  /** @param {SpooledMail} mail */
  async #open({ name }) {
    await this.#attempt(async () => (this.read = await api.spooledMail(name)));
    this.focusOn("#unsent-title");
  }

  #back() {
    this.read = null;
    this.focusOn("#unsent-title");
  }

  #close() {
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).close();
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

customElements.define("unsent-mail", UnsentMail);
