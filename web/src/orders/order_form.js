/** The order form: from, to, for whom, what, when. */
import { html, nothing } from "lit";
import { fetched } from "../service/fetched_again.js";
import { titleOf } from "../service/posts.js";
import { t } from "../texts/texts.js";
import { field, helpWords, problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, Contact, Order, WantedOrder } from "../../types/api_types.ts" */
/** @import { Refused } from "./order_estimate.js" */
/** @import { Schedule, When } from "./order_schedule.js" */

const RECENT = 3;
const WHENS = /** @type {const} */ (["now", "later", "again"]);

export class OrderForm extends PageElement {
  /** The latest choice: modules fetched for an earlier one come too late. @type {"now" | "later" | "again"} */
  #chosen = "now";

  static properties = {
    map: { attribute: false },
    wanted: { attribute: false },
    sent: { attribute: false },
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
    /** @type {Record<string, string>} */
    this.problems = {};
    this.sending = false;
    /** @type {When} */
    this.when = "now";
    /** @type {Schedule} */
    this.schedule = {};
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("wanted") && !changed.get("wanted") && this.wanted.not_before) this.#mend(this.wanted.not_before);
  }

  /** Reserve room for the other parts of the form, and fetch them once the form stands. */
  firstUpdated() {
    import("./order_estimate.js");
  }

  render() {
    return html`<form class="card" novalidate @submit=${this.#submit} @input=${this.#read} @focusin=${begin}>
      <fieldset class="route">
        <legend class="unseen">${t("order.route")}</legend>
        ${this.#postField("from_post", t("order.from"))} ${this.#postField("to_post", t("order.to"))}
      </fieldset>
      ${this.#recipientField()} ${this.#recentRecipients()}
      ${field(
        {
          ...{ name: "description", label: t("order.description"), hint: t("order.description_hint") },
          ...{ problem: this.problems.description, optional: true },
        },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="description" dir="auto" maxlength="500" autocomplete="off"
          .value=${this.wanted.description} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${this.#whenField()} ${this.#estimate()} ${helpWords("window")} ${this.problems.form ? problemLine(this.problems.form) : nothing}
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

  /** The list of those I know is fetched when the field gets the focus. */
  #recipientField() {
    return field(
      { name: "recipient", label: t("order.recipient"), problem: this.problems.recipient },
      ({ id, describedBy, invalid }) => html`<input id=${id} name="recipient" inputmode="email" autocomplete="off" autocapitalize="off"
          spellcheck="false" required role="combobox" aria-autocomplete="list" aria-expanded="false" aria-controls="contact-offers"
          .value=${this.wanted.recipient} aria-describedby=${describedBy} aria-invalid=${invalid} @focus=${loadOffers}
        /><contact-offers @chosen=${(/** @type {CustomEvent<Contact>} */ { detail }) => this.#sendTo(detail)}></contact-offers>`,
    );
  }

  /** Those I sent something last, each a tap away. */
  #recentRecipients() {
    const recent = newestToEach(this.sent).slice(0, RECENT);
    if (!recent.length) return nothing;
    return html`<div class="recent" role="group" aria-label=${t("order.recent")}>
      ${recent.map(
        (order) => html`<button type="button" @click=${() => this.#repeat(order)}>
          <bdi>${order.recipient.name}</bdi><span class="unseen">, </span><small>${this.map ? titleOf(this.map, order.to_post) : nothing}</small>
        </button>`,
      )}
    </div>`;
  }

  #estimate() {
    return html`<order-estimate class="estimate" role="status" .from=${this.wanted.from_post} .to=${this.wanted.to_post} .when=${this.when}
      .schedule=${this.schedule} @refused=${(/** @type {Refused} */ { detail }) => this.#say(detail)}></order-estimate>`;
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

  /** @param {When} when */
  async #when(when) {
    this.#chosen = when;
    const isThere = when === "now" || (await loadSchedule().then(() => true, () => false));
    if (when !== this.#chosen) return;
    if (!isThere) return this.#stay();
    this.when = when;
    this.#say({ form: "" });
  }

  /** Keep the marked choice where the module of the new one could not be fetched. */
  #stay() {
    for (const radio of this.querySelectorAll("input")) if (radio.name === "when") radio.checked = radio.value === this.when;
    this.#say({ form: t("error.no_answer") });
  }

  /** An order for later that was not taken. @param {string} not_before */
  #mend(not_before) {
    this.schedule = { not_before };
    this.#when("later");
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
    const end = await loadEnd().catch(() => undefined);
    if (!end) return this.#say({ form: t("error.no_answer") });
    this.problems = {};
    const { page, kept, problems = {} } = await end.sendOrder(this);
    this.problems = problems;
    if (page) return this.#leaveFor(page);
    // The shell shows what is kept; the form is free for the next one.
    if (kept) return this.#empty();
    this.focusOn("[aria-invalid]");
  }

  #empty() {
    [this.when, this.#chosen, this.schedule] = ["now", "now", {}];
    this.#want({ to_post: "", recipient: "", description: "", not_before: undefined });
  }

  /** Empty the form on going back: else one tap would order the same again. @param {string} page */
  async #leaveFor(page) {
    this.#empty();
    history.replaceState(null, "", location.pathname); // a link that repeats an order fills the form in, too
    await this.updateComplete;
    location.assign(page);
  }
}

/** @param {Order[]} sent newest first */
function newestToEach(sent) {
  const newest = new Map();
  for (const order of sent) if (!newest.has(order.recipient.email)) newest.set(order.recipient.email, order);
  return /** @type {Order[]} */ ([...newest.values()]);
}

const loadSchedule = () => fetched(() => import("./order_schedule.js"), import.meta.resolve("./order_schedule.js"));
const loadEnd = () => fetched(() => import("./send_order.js"), import.meta.resolve("./send_order.js"));
/** Fetch the module that sends the form as soon as a field is used. */
const begin = () => void loadEnd().catch(() => undefined);
const loadOffers = () => import("./contact_offers.js");

customElements.define("order-form", OrderForm);
