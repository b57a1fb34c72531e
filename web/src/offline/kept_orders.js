/** Orders that are kept on this device: those that wait for a network, what became of them, and a way to correct them. */
import { html, nothing } from "lit";
import { followPage, orderPage } from "../service/links.js";
import { OnLive } from "../live/live.js";
import { announce, anyKept, discard, isForLater, isWaiting, keptOrders, sendAgain, sendKept } from "./outbox.js";
import { loadMap, titleOf } from "../service/posts.js";
import { onKept, sayKept } from "../session/session.js";
import { askAgain, isLost, whenBack } from "../session/session_lost.js";
import { hasText, t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap } from "../../types/api_types.ts" */
/** @import { KeptOrder, Refusal } from "./outbox.js" */

/** An answer may get lost while the stream stays open and the browser says nothing of its network. */
const TRY_AGAIN_MS = 5_000;

export class KeptOrders extends PageElement {
  static properties = { person_id: { attribute: false }, kept: { attribute: false }, justNow: { type: Boolean }, map: { state: true } };

  #stop = () => {};
  #timer = 0;
  #send = () => sendKept().catch(() => undefined).then(() => this.#look());

  constructor() {
    super();
    this.person_id = "";
    /** @type {KeptOrder[]} */
    this.kept = [];
    /** True if an order was kept while the page was open: then scroll to it. */
    this.justNow = false;
    /** @type {CampusMap | null} */
    this.map = null;
    // A stream that is open again is the surest sign of a network.
    new OnLive(this, { connected: (connected) => connected && this.#send() });
  }

  connectedCallback() {
    super.connectedCallback();
    this.#stop = onKept(() => this.#look());
    addEventListener("online", this.#send);
    this.#timer = setInterval(() => !document.hidden && this.kept.some(isWaiting) && this.#send(), TRY_AGAIN_MS);
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#stop();
    removeEventListener("online", this.#send);
    clearInterval(this.#timer);
  }

  async firstUpdated() {
    if (this.justNow) this.#come();
    this.#send();
    this.map = await loadMap().catch(() => null);
  }

  async #look() {
    const before = this.kept.length;
    this.kept = await keptOrders(this.person_id);
    // The shell binds them: what it does not know it would take away when it is drawn again.
    this.dispatchEvent(new CustomEvent("kept", { detail: this.kept }));
    sayKept(await anyKept());
    if (this.kept.length > before) this.#come();
  }

  /** While a dialog asks to sign in again, nothing below it takes the keyboard. */
  #come() {
    whenBack(() => this.focusOn(".kept"));
  }

  render() {
    if (!this.kept.length) return nothing;
    return html`<section class="kept" aria-labelledby="kept-title" tabindex="-1">
      <h2 id="kept-title">${t("offline.kept")}</h2>
      <div role="status"><ul>${this.kept.map((order) => this.#order(order))}</ul></div>
    </section>`;
  }

  /** @param {KeptOrder} order */
  #order(order) {
    const { wanted, order_id, refusal } = order;
    return html`<li>
      <div>
        <strong>${this.#title(wanted.from_post)}${icon("arrow")}<span class="unseen">→</span>${this.#title(wanted.to_post)}</strong>
        <span>${t("offline.for", { recipient: wanted.recipient })}</span>
        ${refusal ? problemLine(t("offline.not_sent", { reason: inWords(refusal) })) : html`<span>${t(order_id ? "offline.sent" : "offline.waiting")}</span>`}
      </div>
      <div class="choices">
        ${order_id ? html`<a class="button" href=${followPage(order_id)} @click=${() => discard(order.key)}>${t("offline.follow")}</a>` : nothing}
        ${refusal ? this.#remedy(order, refusal) : nothing}
        <button class="quiet" @click=${() => discard(order.key)}>${t(order_id ? "offline.put_away" : "offline.discard")}</button>
      </div>
    </li>`;
  }

  /** @param {KeptOrder} order @param {Refusal} refusal */
  #remedy(order, refusal) {
    return isForLater(refusal)
      ? html`<button @click=${() => this.#again(order)}>${t("offline.again")}</button>`
      : html`<button @click=${() => mend(order)}>${t("offline.mend")}</button>`;
  }

  /** @param {KeptOrder} order */
  async #again(order) {
    if (isLost()) return askAgain();
    await sendAgain(order).catch(() => undefined);
    announce();
    await this.#look();
  }

  /** @param {string} post */
  #title(post) {
    return this.map ? titleOf(this.map, post) : post;
  }
}

/** @param {Refusal} refusal */
function inWords({ code, detail, fields }) {
  const field = fields.find((name) => hasText(`error.malformed.${name}`));
  if (field) return t(`error.malformed.${field}`);
  return hasText(`error.${code}`) ? t(`error.${code}`) : detail;
}

/** Back into the form; sent from there, it is another order. @param {KeptOrder} order */
async function mend({ key, wanted }) {
  await discard(key);
  location.assign(orderPage(wanted));
}

customElements.define("kept-orders", KeptOrders);
