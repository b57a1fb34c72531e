/** Repeating orders of a person: the next time of each; paused, resumed, ended. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { titleOf } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { inEnglish } from "../texts/reason_words.js";
import { serverNow } from "../service/server_clock.js";
import { isolated, t } from "../texts/texts.js";
import { dayAndTime, weekdayNames, wallClock } from "../texts/times.js";
import "../elements/ask_first.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, StandingOrder } from "../../types/api_types.ts" */

const AT_ONCE = 20;

export class StandingOrders extends PageElement {
  static properties = { map: { attribute: false }, items: { state: true }, next: { state: true }, problem: { state: true } };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {StandingOrder[] | null} */
    this.items = null;
    /** @type {string | null} */
    this.next = null;
    this.problem = "";
  }

  firstUpdated() {
    this.#more();
  }

  render() {
    const { map, items } = this;
    if (!map || !(items ?? this.problem)) return nothing;
    return html`<section class="standing-orders" aria-labelledby="standing-title">
      <h2 id="standing-title">${t("mail.standing")}</h2>
      ${this.problem ? problemLine(this.problem) : nothing}
      ${items?.length
        ? html`<ul class="orders">${items.map((one) => this.#card(one, map))}</ul>`
        : this.problem ? nothing : html`<p class="empty">${t("mail.none_standing")}</p>`}
      ${this.next ? html`<button class="quiet" @click=${() => this.#more()}>${t("mail.more")}</button>` : nothing}
    </section>`;
  }

  /** @param {StandingOrder} one @param {CampusMap} map */
  #card(one, map) {
    const rhythm = rhythmOf(one);
    return html`<li class="order">
      <div class="row">
        <span class="badge ${one.ended ? "cancelled" : one.paused ? "attention" : ""}">${t(badgeOf(one))}</span>
        <span class="who">${one.description ? html`<bdi>${one.description}</bdi>` : t("mail.to", { name: one.recipient.name })}</span>
        <span class="ends">${titleOf(map, one.from_post)}${icon("arrow")}<span class="unseen">→</span>${titleOf(map, one.to_post)}</span>
        <span class="when">${one.description ? html`${t("mail.to", { name: one.recipient.name })} · ` : nothing}${rhythm}</span>
        ${one.next_at ? html`<span class="when">${t("mail.next", { time: dayAndTime(one.next_at, serverNow()) })}</span>` : nothing}
        ${one.why ? html`<span class="when">${inEnglish(one.why)}</span>` : nothing}
      </div>
      ${one.ended ? nothing : this.#actions(one, rhythm)}
    </li>`;
  }

  /** @param {StandingOrder} one @param {string} rhythm */
  #actions(one, rhythm) {
    const what = `${isolated(one.recipient.name)}, ${rhythm}`;
    const turn = one.paused ? /** @type {const} */ ("resume") : "pause";
    const verb = t(one.paused ? "mail.resume" : "mail.pause");
    return html`<div class="under">
      <button class="quiet" aria-label=${t("mail.of", { verb, what })} @click=${() => this.#change(one, turn)}>${verb}</button>
      <ask-first .words=${endWords()} .label=${t("mail.of", { verb: t("mail.end.open"), what })} .act=${() => api.changeStandingOrder(one.id, "end")}
        @done=${(/** @type {CustomEvent<StandingOrder>} */ { detail }) => this.#show(detail)}></ask-first>
    </div>`;
  }

  /** @param {StandingOrder} one @param {"pause" | "resume"} turn */
  #change(one, turn) {
    return this.#attempt(async () => this.#show(await api.changeStandingOrder(one.id, turn)));
  }

  /** @param {StandingOrder} changed */
  #show(changed) {
    this.items = this.items?.map((one) => (one.id === changed.id ? changed : one)) ?? null;
  }

  #more() {
    return this.#attempt(async () => {
      const page = await api.standingOrders({ limit: AT_ONCE, cursor: this.next ?? undefined });
      [this.items, this.next] = [[...(this.items ?? []), ...page.items], page.next];
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

/** Its time is a wall clock's, somewhere. @param {StandingOrder} one */
function rhythmOf({ weekdays, at, zone }) {
  const rhythm = t("mail.every", { days: weekdayNames(weekdays), time: wallClock(at) });
  return zone === Intl.DateTimeFormat().resolvedOptions().timeZone ? rhythm : `${rhythm} (${zone})`;
}

/** @param {StandingOrder} one */
const badgeOf = ({ ended, paused }) => (ended ? "mail.ended" : paused ? "mail.paused" : "mail.running");

const endWords = () => ({
  open: t("mail.end.open"),
  title: t("mail.end.title"),
  body: t("mail.end.body"),
  yes: t("mail.end.yes"),
  no: t("mail.end.no"),
});

customElements.define("standing-orders", StandingOrders);
