/** The order form: from, to, for whom, what. Shows when it would arrive before anything is ordered. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { followPage, PAGES } from "../links.js";
import { atFields } from "../problems.js";
import { serverNow } from "../server_clock.js";
import { personHere } from "../session.js";
import { t } from "../texts.js";
import { estimateView } from "./estimate_view.js";
import { field, problemLine } from "./field.js";
import { helpWords } from "./help_words.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
import { recentRecipients } from "./recent_recipients.js";
/** @import { CampusMap, Contact, Estimate, Order, WantedOrder } from "../api_types.ts" */
/** @import { Schedule } from "./order_schedule.js" */

const FIELD_OF_CODE = {
  unknown_post: "to_post",
  same_post: "to_post",
  no_way: "to_post",
  unknown_recipient: "recipient",
};
const DAY_MS = 86_400_000;
const WHENS = /** @type {const} */ (["now", "later", "again"]);

export class OrderForm extends PageElement {
  static properties = {
    map: { attribute: false },
    wanted: { attribute: false },
    sent: { attribute: false },
    estimate: { state: true },
    problems: { state: true },
    sending: { state: true },
    when: { state: true },
    schedule: { state: true },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {WantedOrder} */
    this.wanted = { from_post: "", to_post: "", recipient: "", description: "" };
    /** @type {Order[]} earlier orders, newest first */
    this.sent = [];
    /** @type {Estimate | "looking" | null} */
    this.estimate = null;
    /** @type {Record<string, string>} */
    this.problems = {};
    this.sending = false;
    /** @type {"now" | "later" | "again"} */
    this.when = "now";
    /** @type {Schedule} */
    this.schedule = {};
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    const before = /** @type {WantedOrder | undefined} */ (changed.get("wanted"));
    const { from_post, to_post } = this.wanted;
    if (changed.has("wanted") && !before && this.wanted.not_before) this.#mend(this.wanted.not_before);
    if (changed.has("wanted") && (before?.from_post !== from_post || before?.to_post !== to_post)) this.#look();
  }

  render() {
    return html`<form class="card" novalidate @submit=${this.#submit} @input=${this.#read}>
      <fieldset class="route">
        <legend class="unseen">${t("order.route")}</legend>
        ${this.#postField("from_post", t("order.from"))} ${this.#postField("to_post", t("order.to"))}
      </fieldset>
      ${this.#recipientField()}
      ${this.map ? recentRecipients(this.map, this.sent, (order) => this.#repeat(order)) : nothing}
      ${field(
        {
          ...{ name: "description", label: t("order.description"), hint: t("order.description_hint") },
          ...{ problem: this.problems.description, optional: true },
        },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="description" maxlength="200" autocomplete="off"
          .value=${this.wanted.description} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${this.#whenField()} ${estimateView(this.estimate, this.#later_ms())} ${helpWords("window")} ${this.problems.form ? problemLine(this.problems.form) : nothing}
      <button class="main" aria-disabled=${this.sending ? "true" : nothing}>
        ${icon("send")}${t(this.sending ? "order.sending" : `order.send.${this.when}`)}
      </button>
    </form>`;
  }

  /** @param {"from_post" | "to_post"} name @param {string} label */
  #postField(name, label) {
    const chosen = this.wanted[name];
    return field({ name, label, problem: this.problems[name] }, ({ id, describedBy, invalid }) => html`<select
      id=${id} name=${name} required aria-describedby=${describedBy} aria-invalid=${invalid}>
      <option value="" disabled ?selected=${!chosen}>${t("order.choose")}</option>
      ${this.map?.posts.map((post) => html`<option value=${post.name} .selected=${post.name === chosen}>${post.title}</option>`)}
    </select>`);
  }

  /** The list of those I know is fetched when somebody comes to the field. */
  #recipientField() {
    return field(
      { name: "recipient", label: t("order.recipient"), problem: this.problems.recipient },
      ({ id, describedBy, invalid }) => html`<input id=${id} name="recipient" inputmode="email" autocomplete="off" autocapitalize="off"
          spellcheck="false" required role="combobox" aria-autocomplete="list" aria-expanded="false" aria-controls="contact-offers"
          .value=${this.wanted.recipient} aria-describedby=${describedBy} aria-invalid=${invalid} @focus=${loadOffers}
        /><contact-offers @chosen=${(/** @type {CustomEvent<Contact>} */ { detail }) => this.#sendTo(detail)}></contact-offers>`,
    );
  }

  #whenField() {
    return html`<fieldset class="pills">
        <legend>${t("order.when")}</legend>
        ${WHENS.map(
          (when) => html`<label class="pill"><input type="radio" name="when" value=${when} .checked=${this.when === when}
            @input=${(/** @type {Event} */ event) => event.stopPropagation()} @change=${() => this.#when(when)} /><span>${t(`order.when.${when}`)}</span></label>`,
        )}
      </fieldset>
      ${this.when === "now"
        ? nothing
        : html`<order-schedule .kind=${this.when} .schedule=${this.schedule} .problem=${this.problems.when ?? ""}
            @scheduled=${(/** @type {CustomEvent<Schedule>} */ { detail }) => (this.schedule = detail)}></order-schedule>`}`;
  }

  /** @param {"now" | "later" | "again"} when */
  async #when(when) {
    if (when !== "now") await import("./order_schedule.js");
    this.when = when;
  }

  /** An order for later that was not taken. @param {string} not_before */
  #mend(not_before) {
    this.schedule = { not_before };
    this.#when("later");
  }

  /** By how much the robot comes later than it would now. */
  #later_ms() {
    const { not_before, at } = this.schedule;
    if (this.when === "again" && at) return untilTime(at);
    return this.when === "later" && not_before ? Math.max(0, Date.parse(not_before) - serverNow()) : 0;
  }

  /** @param {Contact} contact */
  #sendTo({ email, post }) {
    this.#want({ recipient: email, to_post: this.wanted.to_post || post || "" });
  }

  /** @param {Order} order */
  #repeat({ recipient, from_post, to_post }) {
    this.#want({ from_post: this.wanted.from_post || from_post, to_post, recipient: recipient.email });
  }

  /** @param {InputEvent} event */
  #read(event) {
    const input = /** @type {HTMLInputElement | HTMLSelectElement} */ (event.target);
    this.#want({ [input.name]: input.value.trim() });
  }

  /** @param {Partial<WantedOrder>} part */
  #want(part) {
    const { form: _, ...others } = this.problems;
    this.problems = Object.fromEntries(Object.entries(others).filter(([name]) => !(name in part)));
    this.wanted = { ...this.wanted, ...part };
    this.dispatchEvent(new CustomEvent("wanted", { detail: this.wanted }));
  }

  /** Asks when it would arrive, each time that the ends of the way change. */
  async #look() {
    const { from_post, to_post } = this.wanted;
    const stillWanted = () => from_post === this.wanted.from_post && to_post === this.wanted.to_post;
    this.estimate = null;
    if (!from_post || !to_post) return;
    if (from_post === to_post) return this.#say({ to_post: t("error.same_post") });
    this.estimate = "looking";
    try {
      const estimate = await api.estimate(from_post, to_post);
      if (stillWanted()) this.estimate = estimate;
    } catch (failure) {
      if (!stillWanted()) return;
      this.estimate = null;
      this.#say(atFields(failure, FIELD_OF_CODE));
    }
  }

  /** Beside what is said already. @param {Record<string, string>} problems */
  #say(problems) {
    this.problems = { ...this.problems, ...problems };
  }

  /** One at a time, however often it is tapped. @param {SubmitEvent} event */
  async #submit(event) {
    event.preventDefault();
    if (this.sending) return;
    this.sending = true;
    await this.#send().finally(() => (this.sending = false));
  }

  async #send() {
    const [{ looksLikeEmail }, { KeptForLater, placeOrder }] = await Promise.all([import("../email.js"), import("../place_order.js")]);
    this.problems = this.#missing(looksLikeEmail);
    if (Object.keys(this.problems).length) return void this.focusOn("[aria-invalid]");
    try {
      location.assign(await this.#place(placeOrder));
    } catch (failure) {
      // The shell shows what is kept; the form is free for the next one.
      if (failure instanceof KeptForLater) return this.#want({ to_post: "", recipient: "", description: "" });
      this.problems = atFields(failure, FIELD_OF_CODE);
      this.focusOn("[aria-invalid]");
    }
  }

  /** Where it is followed. @param {typeof import("../place_order.js").placeOrder} placeOrder @returns {Promise<string>} */
  async #place(placeOrder) {
    const { weekdays = [], at = "", zone = "", until, not_before } = this.schedule;
    if (this.when === "again") {
      const { not_before: _, ...wanted } = this.wanted;
      await api.placeStandingOrder({ ...wanted, weekdays, at, zone, until });
      return PAGES.mail;
    }
    const wanted = { ...this.wanted, not_before: this.when === "later" ? not_before : undefined };
    return followPage((await placeOrder(wanted, personHere()?.id ?? "")).id);
  }

  /** What a person can see for themselves; everything else is the service's to judge.
   *  @param {(text: string) => boolean} looksLikeEmail @returns {Record<string, string>} */
  #missing(looksLikeEmail) {
    const { from_post, to_post, recipient } = this.wanted;
    return {
      ...(from_post ? {} : { from_post: t("error.missing_from_post") }),
      ...(to_post ? {} : { to_post: t("error.missing_to_post") }),
      ...(recipient ? {} : { recipient: t("error.missing_recipient") }),
      ...(recipient && !looksLikeEmail(recipient) ? { recipient: t("error.malformed.recipient") } : {}),
      ...(this.#isScheduled() ? {} : { when: t("error.missing_when") }),
    };
  }

  #isScheduled() {
    const { not_before, weekdays, at } = this.schedule;
    return this.when === "now" || (this.when === "later" ? Boolean(not_before) : Boolean(weekdays?.length && at));
  }
}

/** How long until it is this time of the day. @param {string} at local, "09:30" */
function untilTime(at) {
  const [hour, minute] = at.split(":").map(Number);
  const then = new Date(serverNow());
  return (then.setHours(hour, minute, 0, 0) - serverNow() + DAY_MS) % DAY_MS;
}

const loadOffers = () => import("./contact_offers.js");

customElements.define("order-form", OrderForm);
