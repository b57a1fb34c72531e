/** Enrolment of a robot: a one-time code, and the tokens that it has had. For maintainers. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago, clockTime, dayAndTime } from "../texts/times.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { EnrolmentCode, RobotToken } from "../../types/api_types.ts" */

const SHOWN = 10;

export class RobotKeys extends PageElement {
  static properties = {
    robot: { attribute: false },
    code: { state: true },
    tokens: { state: true },
    asked: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    this.robot = "";
    /** @type {EnrolmentCode | null} */
    this.code = null;
    /** @type {RobotToken[]} */
    this.tokens = [];
    /** The token that is to be taken back, once more asked about. */
    this.asked = "";
    this.problem = "";
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    return html`<section aria-labelledby="keys-title">
      <h2 id="keys-title">${t("robots.keys")}</h2>
      <p class="hint">${t("robots.keys.hint", { name: this.robot })}</p>
      ${this.problem ? problemLine(this.problem) : nothing}
      <div role="status">${this.code ? shownOnce(this.code) : nothing}</div>
      <button type="button" @click=${this.#makeCode}>${t("robots.keys.code")}</button>
      <h3>${t("robots.tokens")}</h3>
      ${this.tokens.length ? html`<ul class="tokens">${this.tokens.map((token) => this.#token(token))}</ul>` : html`<p class="empty">${t("robots.tokens.none")}</p>`}
      <dialog aria-labelledby="revoke-title" @close=${() => (this.asked = "")}>
        <h2 id="revoke-title">${t("robots.tokens.revoke_title", { prefix: this.asked })}</h2>
        <p>${t("robots.tokens.revoke_body")}</p>
        <div class="choices">
          <button class="main" autofocus @click=${() => this.#dialog.close()}>${t("robots.tokens.keep")}</button>
          <button class="quiet danger" @click=${this.#revoke}>${t("robots.tokens.revoke")}</button>
        </div>
      </dialog>
    </section>`;
  }

  /** @param {RobotToken} token */
  #token({ prefix, created_at, used_at, revoked_at }) {
    const now_ms = serverNow();
    return html`<li class=${revoked_at ? "over" : nothing}>
      <div>
        <code>cmr_${prefix}_…</code>
        <p class="hint">${t("robots.tokens.made", { time: dayAndTime(created_at, now_ms) })}
          ${used_at ? t("robots.tokens.used", { ago: ago(used_at, now_ms) }) : t("robots.tokens.unused")}</p>
      </div>
      ${revoked_at
        ? html`<span class="hint">${t("robots.tokens.over", { time: dayAndTime(revoked_at, now_ms) })}</span>`
        : html`<button class="quiet danger" @click=${() => this.#ask(prefix)}>
            ${t("robots.tokens.revoke")}<span class="unseen">: ${prefix}</span>
          </button>`}
    </li>`;
  }

  get #dialog() {
    return /** @type {HTMLDialogElement} */ (this.querySelector("dialog"));
  }

  /** @param {string} prefix */
  #ask(prefix) {
    this.asked = prefix;
    this.#dialog.showModal();
  }

  async #revoke() {
    const prefix = this.asked;
    this.#dialog.close();
    await this.#attempt(() => api.revokeRobotToken(this.robot, prefix));
    await this.#fetch();
  }

  #makeCode() {
    return this.#attempt(async () => (this.code = await api.makeEnrolmentCode(this.robot)));
  }

  #fetch() {
    return this.#attempt(async () => (this.tokens = (await api.robotTokens(this.robot, { limit: SHOWN })).items));
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

/** @param {EnrolmentCode} code */
const shownOnce = ({ robot, code, expires_at }) => html`<div class="note once">
  <p>${t("robots.keys.type", { robot })}</p>
  <p class="digits">${code}</p>
  <p>${t("robots.keys.until", { time: clockTime(expires_at) })}</p>
</div>`;

customElements.define("robot-keys", RobotKeys);
