/** The base of all parts of the settings: a card with a title; each saves by itself, and says that it has. */
import { html, nothing } from "lit";
import { inWords } from "../service/problems.js";
import { t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";

export class SettingsPart extends PageElement {
  /** @type {import("lit").PropertyDeclarations} */
  static properties = { said: { state: true }, problem: { state: true }, busy: { state: true } };

  constructor() {
    super();
    this.said = "";
    this.problem = "";
    this.busy = false;
  }

  /** @param {string} part @param {unknown} body */
  card(part, body) {
    return html`<section class="card part" id=${part} aria-labelledby="${part}-title">
      <h2 id="${part}-title">${t(`settings.${part}.title`)}</h2>
      <p class="hint">${t(`settings.${part}.lead`)}</p>
      ${body}
      <p class="said" role="status">${this.said ? html`${icon("check")}${this.said}` : nothing}</p>
      ${this.problem ? problemLine(this.problem) : nothing}
    </section>`;
  }

  /** One change at a time. @param {() => Promise<unknown>} act @param {string} [said] once it is done @returns {Promise<boolean>} whether it is */
  async attempt(act, said = "") {
    if (this.busy) return false;
    [this.busy, this.problem, this.said] = [true, "", ""];
    try {
      await act();
      this.said = said;
      return true;
    } catch (failure) {
      this.problem = inWords(failure);
      return false;
    } finally {
      this.busy = false;
    }
  }
}

/** A date where one is needed. @param {string} label @param {unknown} what */
export const remark = (label, what) => html`<span class="remark">${label} ${what}</span>`;
