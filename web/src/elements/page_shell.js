/** The frame around every page: name, pages, unread notifications, account; and the sign-in for visitors. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { mayOpen, PAGES } from "../service/links.js";
import { OnLive, stopLive } from "../live/live.js";
import { askAgain } from "../session/session_lost.js";
import { counted, t } from "../texts/texts.js";
import { address } from "./address.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
/** @import { About, Inbox, Me } from "../../types/api_types.ts" */
/** @import { PageName } from "../service/links.js" */
/** @import { KeptOrder } from "../offline/outbox.js" */
/** @import { SessionEvent } from "../session/session_lost.js" */
/** @import { NewVersion } from "../offline/with_worker.js" */
/** @import { SignInAgain } from "../session/sign_in_again.js" */
/** A browser's own offer to install. @typedef {Event & {prompt: () => Promise<unknown>}} InstallOffer */

const ENTRIES = /** @type {const} */ ([
  ["order", "send"],
  ["mail", "letter"],
  ["notices", "bell"],
  ["mailroom", "tray"],
  ["robots", "robot"],
]);

export class PageShell extends PageElement {
  static properties = {
    page: {},
    about: { attribute: false },
    person: { attribute: false },
    content: { attribute: false },
    kept: { attribute: false },
    takeNewVersion: { state: true },
    installOffer: { state: true },
    inbox: { state: true },
    connected: { state: true },
    lost: { state: true },
  };

  constructor() {
    super();
    /** @type {PageName} */
    this.page = "order";
    /** @type {About | null} */
    this.about = null;
    /** @type {Me | null} */
    this.person = null;
    /** @type {() => unknown} */
    this.content = () => nothing;
    /** @type {KeptOrder[]} orders that wait on this device */
    this.kept = [];
    this.keptJustNow = false;
    /** @type {(() => void) | null} */
    this.takeNewVersion = null;
    /** @type {InstallOffer | null} */
    this.installOffer = null;
    /** @type {Inbox | null} as it was asked for last: before anything is told, the person's own count is enough */
    this.inbox = null;
    this.connected = true;
    /** True if the session has ended without a sign-out. */
    this.lost = false;
    new OnLive(this, {
      notice: () => this.#count(),
      resync: () => this.#count(),
      connected: (connected) => this.#nowConnected(connected),
    });
    this.addEventListener("inbox", (event) => (this.inbox = /** @type {CustomEvent<Inbox>} */ (event).detail));
    addEventListener("new-version", (event) => (this.takeNewVersion = /** @type {NewVersion} */ (event).detail.take));
    addEventListener("session", (event) => this.#session(/** @type {SessionEvent} */ (event).detail));
    addEventListener("beforeinstallprompt", (event) => this.#offer(/** @type {InstallOffer} */ (event)));
    addEventListener("appinstalled", () => (this.installOffer = null));
  }

  /** Said in the account sheet, not across the page. @param {InstallOffer} offer */
  #offer(offer) {
    offer.preventDefault();
    this.installOffer = offer;
  }

  render() {
    return html`
      <a class="skip" href="#content">${t("app.skip")}</a>
      <header class="top">
        <a class="brand" href=${PAGES.order}><img src="/icons/icon.svg" alt="" width="32" height="32" />${t("app.name")}</a>
        ${this.person ? [this.#navigation(this.person), this.#account(this.person)] : nothing}
      </header>
      ${this.lost ? lostBanner() : this.connected ? nothing : html`<p class="banner" role="status">${icon("network")}${t("app.reconnecting")}</p>`}
      ${this.takeNewVersion ? this.#newVersion(this.takeNewVersion) : nothing}
      <main id="content" tabindex="-1">
        ${this.person && this.kept.length ? html`<kept-orders .person_id=${this.person.id} .kept=${this.kept}
          ?justNow=${this.keptJustNow} @kept=${(/** @type {CustomEvent<KeptOrder[]>} */ { detail }) => (this.kept = detail)}></kept-orders>` : nothing}
        ${this.person ? this.#page(this.person) : html`<sign-in .about=${this.about} @signed-in=${() => location.reload()}></sign-in>`}
      </main>
      ${this.person && this.page !== "notices" ? html`<notification-toast .inbox=${this.inbox} .since=${this.about?.now}></notification-toast>` : nothing}
      ${this.person ? html`<sign-in-again .about=${this.about} .email=${this.person.email}></sign-in-again>` : nothing}
      ${this.about?.simulated ? html`<footer class="foot">${t("app.demo")}</footer>` : nothing}
    `;
  }

  /** @param {() => void} take */
  #newVersion(take) {
    return html`<div class="banner new-version" role="status">
      <span>${t("app.new_version")}</span><button @click=${take}>${t("app.new_version.take")}</button>
    </div>`;
  }

  /** @param {Me} person */
  #page(person) {
    if (mayOpen(this.page, person)) return this.content();
    import("../session/no_role.js");
    return html`<no-role .page=${this.page}></no-role>`;
  }

  /** @param {Me} person */
  #navigation(person) {
    return html`<nav class="pages" aria-label=${t("nav.pages")}>
      ${ENTRIES.filter(([page]) => mayOpen(page, person)).map(
        ([page, drawing]) => html`<a href=${PAGES[page]} aria-current=${this.page === page ? "page" : nothing}>
          <span class="glyph">${icon(drawing)}${page === "notices" ? this.#unreadMark() : nothing}</span>
          <span>${t(`nav.${page}`)}</span>
        </a>`,
      )}
    </nav>`;
  }

  get #unread() {
    return this.inbox?.unread ?? this.person?.unread_notices ?? 0;
  }

  #unreadMark() {
    const unread = this.#unread;
    if (!unread) return nothing;
    return html`<span class="unread"><span aria-hidden="true">${unread}</span
      ><span class="unseen">${counted("nav.unread", unread)}</span></span>`;
  }

  /** @param {Me} person */
  #account(person) {
    return html`<details class="account">
      <summary>${initials(person.name)}<span class="unseen"> ${t("account.open")}: ${person.name}</span></summary>
      <div class="sheet">
        <strong><bdi>${person.name}</bdi></strong>${address(person.email)}
        <div class="entries">
          <a class="entry" href=${PAGES.settings} aria-current=${this.page === "settings" ? "page" : nothing}>
            ${icon("settings")}${t("nav.settings")}
          </a>
          <a class="entry" href=${PAGES.order + "?help"}>${icon("help")}${t("help.open")}</a>
          ${this.installOffer ? this.#install(this.installOffer) : nothing}
          <button class="entry" @click=${this.#signOut}>${icon("leave")}${t("account.sign_out")}</button>
        </div>
      </div>
    </details>`;
  }

  /** @param {InstallOffer} offer */
  #install(offer) {
    const accept = () => {
      this.installOffer = null;
      offer.prompt();
    };
    return html`<button class="entry" @click=${accept}>${icon("install")}${t("install.offer")}</button>`;
  }

  async #signOut() {
    const { signOut } = await import("../session/sign_out.js");
    stopLive();
    await signOut();
    location.assign(PAGES.order);
  }

  /** The page of the notifications asks by itself, and tells. */
  async #count() {
    if (!this.person || this.page === "notices") return;
    [this.inbox] = await Promise.all([api.notices().catch(() => this.inbox), import("./notification_toast.js").catch(() => undefined)]);
  }

  /** @param {Map<string, unknown>} changed */
  updated(changed) {
    if (this.person && (changed.has("person") || changed.has("inbox"))) navigator.setAppBadge?.(this.#unread).catch(() => undefined);
  }

  /** @param {boolean} connected */
  async #nowConnected(connected) {
    this.connected = connected;
    // A stream that was refused does not say why.
    if (!connected) await api.me().catch(() => undefined);
  }

  /** @param {"lost" | "back"} what */
  async #session(what) {
    this.lost = what === "lost";
    const again = /** @type {Partial<SignInAgain>} */ (this.querySelector("sign-in-again"));
    if (!this.lost) return again.close?.();
    await import("../session/sign_in_again.js");
    if (this.lost) again.open?.();
  }
}

const lostBanner = () => html`<div class="banner new-version" role="status">
  <span>${t("sign_in.lost")}</span><button @click=${askAgain}>${t("sign_in.again")}</button>
</div>`;

/** "Ada Lovelace" → "AL" @param {string} name */
const initials = (name) =>
  name.split(/[\s.]+/).map((word) => word[0] ?? "").slice(0, 2).join("").toUpperCase();

customElements.define("page-shell", PageShell);
