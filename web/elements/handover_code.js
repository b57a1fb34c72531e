/** My code as a QR picture, what to do with it, and, in a demonstration, hands to hold it up with. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { inWords } from "../problems.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { dayAndTime } from "../times.js";
import { problemLine } from "./field.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
/** @import { HandoverCode, Purpose } from "../api_types.ts" */

export class HandoverCodeElement extends PageElement {
  static properties = {
    order_id: { attribute: false },
    purpose: { attribute: false },
    needed: { type: Boolean },
    demo: { type: Boolean },
    code: { state: true },
    problem: { state: true },
    shown: { state: true },
  };

  constructor() {
    super();
    this.order_id = "";
    /** @type {Purpose | null} */
    this.purpose = null;
    /** Whether the robot is there and asks for it. */
    this.needed = false;
    this.demo = false;
    /** @type {HandoverCode | null} */
    this.code = null;
    this.problem = "";
    this.shown = false;
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("purpose") || changed.has("order_id")) this.#fetch();
  }

  render() {
    if (!this.purpose) return nothing;
    return html`<section class="card code" aria-labelledby="code-title">
      <h2 id="code-title">${t(`code.title.${this.purpose}`)}</h2>
      ${this.needed
        ? this.#open(this.purpose)
        : html`<p>${t("code.later")}</p>
            <details><summary>${t("code.show")}</summary>${this.#open(this.purpose)}</details>`}
    </section>`;
  }

  /** @param {Purpose} purpose */
  #open(purpose) {
    return html`<div class="handover">
      ${this.code ? html`<img class="qr" src=${this.code.svg_url} alt=${t("code.image")} width="260" height="260" />` : nothing}
      <div>
        <ol class="steps">
          <li>${t(`code.how.${purpose}.1`)}</li>
          <li>${t(`code.how.${purpose}.2`)}</li>
        </ol>
        <p class="hint">${t("code.offline")}</p>
        ${this.#validity()}
        ${this.demo && this.needed
          ? html`<button class="main" @click=${this.#showToCamera}>${icon("camera")}${t("code.camera")}</button>`
          : nothing}
        <p role="status">${this.shown ? t("code.camera_done") : nothing}</p>
        ${this.problem ? problemLine(this.problem) : nothing}
      </div>
    </div>`;
  }

  #validity() {
    const until = this.code?.expires_at;
    return until ? html`<p class="hint">${t("code.expires", { time: dayAndTime(until, serverNow()) })}</p>` : nothing;
  }

  async #fetch() {
    this.code = null;
    this.shown = false;
    if (this.purpose) await this.#attempt(async () => (this.code = await api.handoverCode(this.order_id)));
  }

  async #showToCamera() {
    await this.#attempt(async () => {
      await api.showCodeToCamera(this.order_id);
      this.shown = true;
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

customElements.define("handover-code", HandoverCodeElement);
