/** The order form: from, to, for whom, what. Shows when it would arrive before anything is ordered. */
import { html, nothing } from "lit";
import * as api from "../api.js";
import { followPage } from "../links.js";
import { titleOf } from "../posts.js";
import { atFields } from "../problems.js";
import { personHere } from "../session.js";
import { t } from "../texts.js";
import { estimateView } from "./estimate_view.js";
import { field, problemLine } from "./field.js";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";
/** @import { CampusMap, Estimate, Order, WantedOrder } from "../api_types.ts" */

const FIELD_OF_CODE = {
  unknown_post: "to_post",
  same_post: "to_post",
  no_way: "to_post",
  unknown_recipient: "recipient",
};
const RECENT = 3;

export class OrderForm extends PageElement {
  static properties = {
    map: { attribute: false },
    wanted: { attribute: false },
    sent: { attribute: false },
    estimate: { state: true },
    problems: { state: true },
    sending: { state: true },
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
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    const before = /** @type {WantedOrder | undefined} */ (changed.get("wanted"));
    const { from_post, to_post } = this.wanted;
    if (changed.has("wanted") && (before?.from_post !== from_post || before?.to_post !== to_post)) this.#look();
  }

  render() {
    return html`<form class="card" novalidate @submit=${this.#submit} @input=${this.#read}>
      <fieldset class="route">
        <legend class="unseen">${t("order.route")}</legend>
        ${this.#postField("from_post", t("order.from"))} ${this.#postField("to_post", t("order.to"))}
      </fieldset>
      ${field(
        { name: "recipient", label: t("order.recipient"), problem: this.problems.recipient },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="recipient" type="email" autocomplete="off" required
          .value=${this.wanted.recipient} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${this.#recent()}
      ${field(
        {
          ...{ name: "description", label: t("order.description"), hint: t("order.description_hint") },
          ...{ problem: this.problems.description, optional: true },
        },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="description" maxlength="200" autocomplete="off"
          .value=${this.wanted.description} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${estimateView(this.estimate)} ${this.problems.form ? problemLine(this.problems.form) : nothing}
      <button class="main" aria-disabled=${this.sending ? "true" : nothing}>
        ${icon("send")}${t(this.sending ? "order.sending" : "order.send")}
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

  #recent() {
    const { map } = this;
    const recent = map ? recentRecipients(this.sent) : [];
    if (!map || !recent.length) return nothing;
    return html`<div class="recent" role="group" aria-label=${t("order.recent")}>
      ${recent.map(
        (order) => html`<button type="button" @click=${() => this.#repeat(order)}>
          <span>${order.recipient.name}</span><span class="unseen">, </span><small>${titleOf(map, order.to_post)}</small>
        </button>`,
      )}
    </div>`;
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

  /** @param {SubmitEvent} event */
  async #submit(event) {
    event.preventDefault();
    if (this.sending) return;
    this.problems = this.#missing();
    if (Object.keys(this.problems).length) return this.focusOn("[aria-invalid]");
    this.sending = true;
    const { KeptForLater, placeOrder } = await import("../place_order.js");
    try {
      location.assign(followPage((await placeOrder(this.wanted, personHere()?.id ?? "")).id));
    } catch (failure) {
      // The shell shows what is kept; the form is free for the next one.
      if (failure instanceof KeptForLater) return this.#want({ to_post: "", recipient: "", description: "" });
      this.problems = atFields(failure, FIELD_OF_CODE);
      this.focusOn("[aria-invalid]");
    } finally {
      this.sending = false;
    }
  }

  /** What a person can see for themselves; everything else is the service's to judge. @returns {Record<string, string>} */
  #missing() {
    const { from_post, to_post, recipient } = this.wanted;
    const input = /** @type {HTMLInputElement} */ (this.querySelector("[name=recipient]"));
    return {
      ...(from_post ? {} : { from_post: t("error.missing_from_post") }),
      ...(to_post ? {} : { to_post: t("error.missing_to_post") }),
      ...(recipient ? {} : { recipient: t("error.missing_recipient") }),
      ...(input.validity.typeMismatch ? { recipient: t("error.malformed.recipient") } : {}),
    };
  }
}

/** The newest order to each person. @param {Order[]} sent */
function recentRecipients(sent) {
  const newest = new Map();
  for (const order of sent) if (!newest.has(order.recipient.email)) newest.set(order.recipient.email, order);
  return [...newest.values()].slice(0, RECENT);
}

customElements.define("order-form", OrderForm);
