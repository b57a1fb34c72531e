/** Delegates who meet the robot for a person: added here, with a code of their own to be shared; revoked here too. */
import { html, nothing } from "lit";
import { looksLikeEmail } from "../session/email.js";
import { ApiProblem } from "../service/api.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { address } from "../elements/address.js";
import { field, problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Delegate, NewDelegate, ShownCode } from "../../types/api_types.ts" */

/**
 * Naming delegates: signed in, with a list of them, or by the link in a mail, where each is shown once.
 * @typedef {{name: (request: NewDelegate) => Promise<{delegate: Delegate, code: ShownCode}>,
 *   list: (() => Promise<Delegate[]>) | null, revoke: (id: string) => Promise<unknown>, code: (id: string) => Promise<ShownCode>}} Naming
 */

export class OrderDelegates extends PageElement {
  static properties = {
    naming: { attribute: false },
    items: { state: true },
    shown: { state: true },
    problem: { state: true },
    said: { state: true },
  };

  constructor() {
    super();
    /** @type {Naming | null} */
    this.naming = null;
    /** @type {Delegate[]} */
    this.items = [];
    /** The delegate whose code is shown. @type {{delegate: Delegate, code: ShownCode} | null} */
    this.shown = null;
    this.problem = "";
    this.said = "";
  }

  firstUpdated() {
    this.#attempt(() => this.#fetch());
  }

  render() {
    return html`<p>${t("delegate.lead")}</p>
      ${this.items.length ? html`<ul class="rows">${this.items.map((one) => this.#row(one))}</ul>` : nothing}
      ${this.shown ? this.#code(this.shown) : nothing} ${this.#form()}
      <p class="said" role="status">${this.said || nothing}</p>
      ${this.problem ? problemLine(this.problem) : nothing}`;
  }

  /** @param {Delegate} one */
  #row(one) {
    const { id, name, email, revoked_at } = one;
    return html`<li>
      <span><strong><bdi>${name}</bdi></strong>${email ? address(email) : html`<span class="address">${t("delegate.no_mail")}</span>`}</span>
      ${revoked_at
        ? html`<span class="badge cancelled">${t("delegate.revoked")}</span>`
        : html`<span class="does">
            <button class="quiet" aria-label="${t("delegate.show")}, ${name}" @click=${() => this.#show(one)}>${t("delegate.show")}</button>
            <button class="quiet danger" aria-label="${t("delegate.revoke")}, ${name}" @click=${() => this.#revoke(id)}>${t("delegate.revoke")}</button>
          </span>`}
    </li>`;
  }

  /** @param {{delegate: Delegate, code: ShownCode}} shown */
  #code({ delegate, code }) {
    return html`<figure class="passed" aria-labelledby="passed-title">
      <img class="qr" src=${code.picture} alt=${t("delegate.code", { name: delegate.name })} width="220" height="220" />
      <figcaption>
        <strong id="passed-title">${t("delegate.code", { name: delegate.name })}</strong>
        <p class="number">${inThrees(code.digits)}</p>
        <p class="hint">${t("delegate.pass_on")} ${t("code.expires", { time: dayAndTime(code.expires_at, serverNow()) })}</p>
      </figcaption>
    </figure>`;
  }

  #form() {
    return html`<form novalidate @submit=${this.#name}>
      ${field({ name: "delegate_name", label: t("delegate.name") }, ({ id }) => html`<input id=${id} name="delegate_name" dir="auto" maxlength="80" autocomplete="off" required />`)}
      ${field(
        { name: "delegate_email", label: t("delegate.email"), hint: t("delegate.email_hint"), optional: true },
        ({ id, describedBy }) => html`<input id=${id} name="delegate_email" type="email" autocomplete="off" aria-describedby=${describedBy} />`,
      )}
      <button>${t("delegate.send")}</button>
    </form>`;
  }

  /** @param {SubmitEvent} event */
  async #name(event) {
    event.preventDefault();
    const form = /** @type {HTMLFormElement} */ (event.target);
    const written = new FormData(form);
    const [name, email] = ["delegate_name", "delegate_email"].map((field) => `${written.get(field)}`.trim());
    if (!name || (email && !looksLikeEmail(email))) return void (this.problem = t(name ? "error.malformed.email" : "delegate.name_missing"));
    await this.#attempt(async (naming) => {
      this.shown = await naming.name(email ? { name, email } : { name });
      this.said = t(email ? "delegate.told" : "delegate.named", { name });
      form.reset();
      await this.#fetch();
    });
  }

  /** @param {Delegate} delegate */
  #show(delegate) {
    return this.#attempt(async (naming) => (this.shown = { delegate, code: await naming.code(delegate.id) }));
  }

  /** @param {string} id */
  #revoke(id) {
    return this.#attempt(async (naming) => {
      await naming.revoke(id);
      if (this.shown?.delegate.id === id) this.shown = null;
      await this.#fetch();
    });
  }

  async #fetch() {
    if (this.naming?.list) this.items = await this.naming.list();
  }

  /** @param {(naming: Naming) => Promise<unknown>} attempt */
  async #attempt(attempt) {
    [this.problem, this.said] = ["", ""];
    try {
      if (this.naming) await attempt(this.naming);
    } catch (failure) {
      const isAddress = failure instanceof ApiProblem && failure.code === "address_not_allowed";
      this.problem = isAddress ? t("delegate.address") : inWords(failure);
    }
  }
}

/** "123 456" @param {string} digits */
export const inThrees = (digits) => digits.replace(/(\d{3})(?=\d)/g, "$1\u00a0");

customElements.define("order-delegates", OrderDelegates);
