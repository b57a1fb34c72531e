/** A first visitor's guide in three steps: dismissed by a tap, found again under the account. */
import { html, svg } from "lit";
import { putFirstHelpAway } from "./session.js";
import { t } from "../texts/texts.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";

const robot = svg`<rect x="34" y="34" width="28" height="22" rx="9" class="solid"/><path d="M43 43v3M53 43v3M48 34v-7"/><circle cx="48" cy="25" r="2"/>`;

const DRAWINGS = [
  svg`<rect x="28" y="10" width="40" height="56" rx="7" class="paper"/><path d="M36 22h24M36 31h16"/><rect x="36" y="44" width="24" height="12" rx="6" class="solid"/>`,
  svg`${robot}<path d="M8 62h80"/><rect x="66" y="30" width="22" height="22" rx="3" class="paper"/><path d="M71 35h4v4h-4zM79 35h4v4h-4zM71 43h4v4h-4zM80 44h3"/><circle cx="41" cy="60" r="3"/><circle cx="55" cy="60" r="3"/>`,
  svg`<circle cx="30" cy="24" r="8" class="paper"/><path d="M16 60c0-12 6-19 14-19s14 7 14 19M8 62h80"/><rect x="52" y="34" width="32" height="21" rx="3" class="solid"/><path d="m53 37 15 10 15-10" class="on"/>`,
];

export class FirstSteps extends PageElement {
  render() {
    return html`<section class="card first-steps" aria-labelledby="steps-title">
      <h2 id="steps-title">${t("help.title")}</h2>
      <ol>
        ${DRAWINGS.map(
          (drawing, i) => html`<li>
            <svg viewBox="0 0 96 72" aria-hidden="true">${drawing}</svg>
            <span>${t(`help.step_${i + 1}`)}</span>
          </li>`,
        )}
      </ol>
      <button class="quiet" @click=${this.#putAway}>${icon("check")}${t("help.understood")}</button>
    </section>`;
  }

  #putAway() {
    putFirstHelpAway();
    this.dispatchEvent(new CustomEvent("put-away"));
  }
}

customElements.define("first-steps", FirstSteps);
