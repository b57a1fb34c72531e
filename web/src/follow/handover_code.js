/** My code as a QR picture, what to do with it, a tap instead, and, in a demonstration, hands to hold it up with. */
import { html, nothing } from "lit";
import { inWords } from "../service/problems.js";
import { serverNow } from "../service/server_clock.js";
import { robotAsked } from "./shows_outcome.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { helpWords, problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Purpose, ShownCode } from "../../types/api_types.ts" */

/**
 * The calls for a code and its hand-over: signed in, or by the link in a mail.
 * @typedef {{code: () => Promise<ShownCode>, handOver: (digits?: string) => Promise<unknown>, showToCamera: (() => Promise<unknown>) | null}} Door
 */

export class HandoverCodeElement extends PageElement {
  static properties = {
    door: { attribute: false },
    purpose: { attribute: false },
    needed: { type: Boolean },
    asked: { type: Boolean },
    code: { state: true },
    opened: { state: true },
    problem: { state: true },
    said: { state: true },
  };
  /** @type {import("../elements/stays_awake.js").StaysAwake | null} */
  #awake = null;

  constructor() {
    super();
    /** @type {Door | null} */
    this.door = null;
    /** @type {Purpose | null} */
    this.purpose = null;
    /** True while the robot waits for this code. */
    this.needed = false;
    /** True from the request to hand over until the robot answers. */
    this.asked = false;
    /** @type {ShownCode | null} */
    this.code = null;
    /** True if the code is shown before it is needed. */
    this.opened = false;
    this.problem = "";
    this.said = "";
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("purpose") || changed.has("door")) this.#fetch();
  }

  get isShown() {
    return this.code !== null && (this.needed || this.opened);
  }

  /** A screen that goes dark cannot be held to a camera. */
  async updated() {
    if (!this.isShown || this.#awake) return;
    const { StaysAwake } = await import("../elements/stays_awake.js");
    this.#awake ??= new StaysAwake(this, () => this.isShown);
  }

  render() {
    if (!this.purpose) return nothing;
    return html`<section class="card code" aria-labelledby="code-title">
      <h2 id="code-title">${t(`code.title.${this.purpose}`)}</h2>
      ${this.needed
        ? this.#open(this.purpose)
        : html`<p>${t("code.later")}</p>
            <details @toggle=${this.#toggled}><summary>${t("code.show")}</summary>${this.#open(this.purpose)}</details>`}
    </section>`;
  }

  /** @param {Purpose} purpose */
  #open(purpose) {
    return html`<div class="handover">
      ${this.code ? html`<img class="qr" src=${this.code.picture} alt=${t("code.image")} width="260" height="260" />` : nothing}
      <div>
        <ol class="steps">
          <li>${t(`code.how.${purpose}.1`)}</li>
          <li>${t(`code.how.${purpose}.2`)}</li>
        </ol>
        <p class="hint">${t("code.offline")}</p>
        ${helpWords("code")}
        ${this.#digits()} ${this.#validity()} ${this.needed ? this.#withoutCode(purpose) : nothing}
        <p role="status">${this.asked ? t("code.asked") : this.said}</p>
        ${this.problem ? problemLine(this.problem) : nothing}
      </div>
    </div>`;
  }

  /** To be told to the person who types them: they do the same as the picture, and need a network. */
  #digits() {
    const { code } = this;
    if (!code) return nothing;
    if (code.digits_locked) return html`<p class="hint">${t("error.digits_locked")}</p>`;
    return html`<p class="hint">${t("code.digits")} <strong class="number">${code.digits.slice(0, 3)}&nbsp;${code.digits.slice(3)}</strong></p>`;
  }

  #validity() {
    const until = this.code?.expires_at;
    return until ? html`<p class="hint">${t("code.expires", { time: dayAndTime(until, serverNow()) })}</p>` : nothing;
  }

  /** With a network, a tap asks the robot to do the same. @param {Purpose} purpose */
  #withoutCode(purpose) {
    const camera = html`<button class="main" @click=${this.#showToCamera}>${icon("camera")}${t("code.camera")}</button>`;
    return html`<div class="choices">
      ${this.door?.showToCamera ? camera : nothing}
      <button class="quiet" aria-disabled=${this.asked ? "true" : nothing} @click=${this.#handOver}>${t(`code.tap.${purpose}`)}</button>
    </div>`;
  }

  /** @param {Event} event */
  #toggled(event) {
    this.opened = /** @type {HTMLDetailsElement} */ (event.target).open;
  }

  async #fetch() {
    this.code = null;
    this.said = "";
    if (this.purpose) await this.#attempt(async (door) => (this.code = await door.code()));
  }

  async #handOver() {
    if (this.asked) return;
    this.dispatchEvent(robotAsked());
    await this.#attempt(async (door) => {
      await door.handOver("");
      this.said = t("code.asked");
    });
  }

  async #showToCamera() {
    this.dispatchEvent(robotAsked());
    await this.#attempt(async (door) => {
      await door.showToCamera?.();
      this.said = t("code.camera_done");
    });
  }

  /** @param {(door: Door) => Promise<unknown>} attempt */
  async #attempt(attempt) {
    this.problem = "";
    try {
      if (this.door) await attempt(this.door);
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

customElements.define("handover-code", HandoverCodeElement);
