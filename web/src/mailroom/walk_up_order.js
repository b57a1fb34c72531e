/** An order for a visitor at the mailroom's desk: who sends, who receives, where to; then a slip to go with the mail. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { followPage, slipPage } from "../service/links.js";
import { orderTitle } from "./mailroom_words.js";
import { loadMap } from "../service/posts.js";
import { atFields, FIELD_OF_CODE } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { field, problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
import "../session/person_box.js";
/** @import { CampusMap, Order, WalkUpOrder } from "../../types/api_types.ts" */
/** @import { PersonBox } from "../session/person_box.js" */

/** @type {WalkUpOrder} */
const NOTHING = { on_behalf_of: "", recipient: "", from_post: "", to_post: "", description: "", priority: "normal" };
const PRIORITIES = /** @type {const} */ (["normal", "high", "low"]);

export class WalkUpOrderElement extends PageElement {
  /** One per order as it is filled in: sending it again after a lost answer does not order it twice. */
  #key = "";

  static properties = {
    map: { state: true },
    wanted: { state: true },
    placed: { state: true },
    problems: { state: true },
    busy: { state: true },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    this.wanted = NOTHING;
    /** @type {Order | null} the order, once there is one */
    this.placed = null;
    /** @type {Record<string, string>} */
    this.problems = {};
    this.busy = false;
  }

  async open() {
    this.map = await loadMap();
    if (this.placed || !this.wanted.from_post) await this.#begin();
    await this.updateComplete;
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).showModal();
    this.focusOn("[name=sender]");
  }

  async #begin() {
    const from_post = this.map?.posts.find(({ mailroom }) => mailroom)?.name ?? "";
    [this.wanted, this.placed, this.problems, this.#key] = [{ ...NOTHING, from_post }, null, {}, crypto.randomUUID()];
    await this.updateComplete;
    for (const box of /** @type {NodeListOf<PersonBox>} */ (this.querySelectorAll("person-box"))) box.clear();
  }

  render() {
    return html`<dialog class="ask wide" aria-labelledby="walk-up-title">
      ${this.placed ? this.#done(this.placed) : this.#form()}
    </dialog>`;
  }

  #form() {
    const { problems } = this;
    return html`<form novalidate @submit=${this.#submit} @input=${this.#read}>
      <h2 id="walk-up-title">${t("mailroom.walk_up.title")}</h2>
      ${this.#person("sender", "on_behalf_of")} ${this.#person("recipient", "recipient")}
      <div class="pair">${this.#post("from_post", t("order.from"))} ${this.#post("to_post", t("order.to"))}</div>
      ${field(
        { name: "description", label: t("order.description"), problem: problems.description, optional: true },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="description" dir="auto" maxlength="500" autocomplete="off"
          .value=${this.wanted.description} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${field(
        { name: "priority", label: t("mailroom.priority") },
        ({ id }) => html`<select id=${id} name="priority">
          ${PRIORITIES.map((one) => html`<option value=${one} .selected=${one === this.wanted.priority}>${t(`mailroom.priority.${one}`)}</option>`)}
        </select>`,
      )}
      ${problems.form ? problemLine(problems.form) : nothing}
      <div class="choices">
        <button class="main" aria-disabled=${this.busy ? "true" : nothing}>${icon("send")}${t("mailroom.walk_up.yes")}</button>
        <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.not_now")}</button>
      </div>
    </form>`;
  }

  /** @param {"sender" | "recipient"} name @param {"on_behalf_of" | "recipient"} part */
  #person(name, part) {
    return html`<person-box .name=${name} .label=${t(`mailroom.walk_up.${name}`)} .problem=${this.problems[name] ?? ""}
      @chosen=${(/** @type {CustomEvent<string>} */ event) => this.#want({ [part]: event.detail }, name)}></person-box>`;
  }

  /** @param {"from_post" | "to_post"} name @param {string} label */
  #post(name, label) {
    const chosen = this.wanted[name];
    return field({ name, label, problem: this.problems[name] }, ({ id, describedBy, invalid }) => html`<select
      id=${id} name=${name} required aria-describedby=${describedBy} aria-invalid=${invalid}>
      <option value="" disabled .selected=${!chosen}>${t("order.choose")}</option>
      ${this.map?.posts.map((post) => html`<option value=${post.name} .selected=${post.name === chosen}>${post.title}</option>`)}
    </select>`);
  }

  /** @param {Order} order */
  #done(order) {
    return html`<h2 id="walk-up-title" tabindex="-1">${t("mailroom.walk_up.done")}</h2>
      <p>${orderTitle(order)}</p>
      <div class="choices">
        <a class="button primary" href=${slipPage(order.id)}>${t("print.slip.open")}</a>
        <a class="button" href=${followPage(order.id)}>${t("mailroom.walk_up.follow")}</a>
        <button type="button" @click=${this.#again}>${t("mailroom.walk_up.again")}</button>
        <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.close")}</button>
      </div>`;
  }

  /** @param {InputEvent} event */
  #read(event) {
    const { name, value } = /** @type {HTMLInputElement | HTMLSelectElement} */ (event.target);
    this.#want({ [name]: value.trim() }, name);
  }

  /** @param {Partial<WalkUpOrder>} part @param {string} name of the field */
  #want(part, name) {
    const { [name]: _, form: __, ...others } = this.problems;
    [this.problems, this.wanted, this.#key] = [others, { ...this.wanted, ...part }, crypto.randomUUID()];
  }

  /** @param {SubmitEvent} event */
  async #submit(event) {
    event.preventDefault();
    if (this.busy) return;
    this.problems = this.#missing();
    if (Object.keys(this.problems).length) return this.focusOn("[aria-invalid]");
    this.busy = true;
    try {
      this.placed = await api.placeOrder(this.wanted, this.#key);
      this.focusOn("#walk-up-title");
    } catch (failure) {
      const { on_behalf_of, ...problems } = atFields(failure, { ...FIELD_OF_CODE, unknown_sender: "sender" });
      this.problems = on_behalf_of ? { ...problems, sender: on_behalf_of } : problems;
      if (failure instanceof api.NoAnswer) this.problems = { form: t("error.no_answer_order") };
      this.focusOn("[aria-invalid]");
    } finally {
      this.busy = false;
    }
  }

  /** @returns {Record<string, string>} */
  #missing() {
    const { on_behalf_of, recipient, from_post, to_post } = this.wanted;
    return {
      ...(on_behalf_of ? {} : { sender: t("mailroom.walk_up.no_sender") }),
      ...(recipient ? {} : { recipient: t("error.missing_recipient") }),
      ...(from_post ? {} : { from_post: t("error.missing_from_post") }),
      ...(to_post ? {} : { to_post: t("error.missing_to_post") }),
    };
  }

  async #again() {
    await this.#begin();
    this.focusOn("[name=sender]");
  }

  #close() {
    /** @type {HTMLDialogElement} */ (this.querySelector("dialog")).close();
  }
}

customElements.define("walk-up-order", WalkUpOrderElement);
