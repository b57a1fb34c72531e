/**
 * Asks once before something is done: what follows from it in words, a choice and a reason where they are needed.
 * With several actions it asks first which one. Tells `done` with what the service answered.
 */
import { html, nothing } from "lit";
import { ApiProblem } from "../service/api.js";
import { atFields } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { field, problemLine } from "./field.js";
import { PageElement } from "./page_element.js";
/** @import { Action } from "../mailroom/mailroom_actions.js" */

const LONGEST_REASON = 500;

export class AskDialog extends PageElement {
  static properties = {
    actions: { state: true },
    action: { state: true },
    heading: { state: true },
    problems: { state: true },
    busy: { state: true },
  };

  constructor() {
    super();
    /** @type {Action[]} to choose from */
    this.actions = [];
    /** @type {Action | null} that is asked about */
    this.action = null;
    this.heading = "";
    /** @type {Record<string, string>} */
    this.problems = {};
    this.busy = false;
  }

  /** The keyboard goes back by itself to where it was. @param {Action[]} actions @param {string} heading what they are about */
  async ask(actions, heading) {
    [this.actions, this.heading, this.problems, this.busy] = [actions, heading, {}, false];
    this.action = actions.length === 1 ? actions[0] : null;
    await this.updateComplete;
    this.#dialog.showModal();
    this.#focus();
  }

  render() {
    return html`<dialog class="ask" aria-labelledby="ask-title" @close=${this.#forget}>
      ${this.action ? this.#question(this.action) : this.#menu()}
    </dialog>`;
  }

  #menu() {
    return html`<h2 id="ask-title">${this.heading}</h2>
      <ul class="menu">
        ${this.actions.map(
          (action) => html`<li><button type="button" class=${action.danger ? "danger" : ""} @click=${() => this.#choose(action)}>
            ${t(`mailroom.do.${action.name}`)}
          </button></li>`,
        )}
      </ul>
      <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.close")}</button>`;
  }

  /** @param {Action} action */
  #question(action) {
    return html`<form novalidate @submit=${this.#submit}>
      <div>
        <h2 id="ask-title">${t(`mailroom.do.${action.name}.title`, action.names)}</h2>
        <p id="ask-body">${t(`mailroom.do.${action.name}.body`, action.names)}</p>
      </div>
      ${action.choices ? this.#choices(action) : nothing} ${action.reason ? this.#reason(action) : nothing}
      ${this.problems.form ? problemLine(this.problems.form) : nothing}
      <div class="choices">
        <button class=${action.danger ? "main grave" : "main"} aria-disabled=${this.busy ? "true" : nothing}
          aria-describedby="ask-body">${t(`mailroom.do.${action.name}.yes`, action.names)}</button>
        <button type="button" class="quiet" @click=${this.#close}>${t("mailroom.not_now")}</button>
      </div>
    </form>`;
  }

  /** @param {Action} action */
  #choices({ choices = [], chosen }) {
    return html`<fieldset class="options">
      <legend class="unseen">${t("mailroom.choice")}</legend>
      ${choices.map(
        ({ value, label, hint }) => html`<label>
          <input type="radio" name="choice" value=${value} .checked=${value === chosen} />
          <span>${label}${hint ? html`<small>${hint}</small>` : nothing}</span>
        </label>`,
      )}
    </fieldset>`;
  }

  /** @param {Action} action */
  #reason({ reason, suggestion = "" }) {
    return field(
      { name: "reason", label: t("mailroom.reason"), problem: this.problems.reason, optional: reason === "may" },
      ({ id, describedBy, invalid }) => html`<input id=${id} name="reason" dir="auto" maxlength=${LONGEST_REASON} autocomplete="off"
        .value=${suggestion} ?required=${reason === "needed"} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
    );
  }

  get #dialog() {
    return /** @type {HTMLDialogElement} */ (this.querySelector("dialog"));
  }

  /** Where something is to be typed, the field; where all is said, the button: one key says yes. */
  #focus() {
    const empty = this.action?.reason === "needed" && !this.action.suggestion;
    const chosen = this.action?.choices && "input:checked";
    this.focusOn(!this.action ? ".menu button" : empty ? "[name=reason]" : chosen || "button.main");
  }

  /** @param {Action} action */
  #choose(action) {
    this.action = action;
    this.#focus();
  }

  /** @param {SubmitEvent} event */
  async #submit(event) {
    event.preventDefault();
    const { action } = this;
    if (!action || this.busy) return;
    const answer = new FormData(/** @type {HTMLFormElement} */ (event.target));
    const [reason, choice] = ["reason", "choice"].map((name) => `${answer.get(name) ?? ""}`.trim());
    if (action.reason === "needed" && !reason) return this.#refuse({ reason: t("mailroom.reason_missing") });
    this.busy = true;
    try {
      const detail = { action, answer: await action.run({ reason, choice }) };
      this.#close();
      this.dispatchEvent(new CustomEvent("done", { detail }));
    } catch (failure) {
      this.#refuse(atFields(failure, {}));
      if (failure instanceof ApiProblem) this.dispatchEvent(new CustomEvent("refused"));
    } finally {
      this.busy = false;
    }
  }

  /** @param {Record<string, string>} problems */
  #refuse(problems) {
    this.problems = problems;
    this.focusOn("[aria-invalid]");
  }

  #close() {
    this.#dialog.close();
  }

  #forget() {
    [this.action, this.actions] = [null, []];
  }
}

customElements.define("ask-dialog", AskDialog);
