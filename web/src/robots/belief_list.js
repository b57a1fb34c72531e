/** Beliefs of a robot: recent changes, marked by a sign, and the whole list; both filtered by a word. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { t } from "../texts/texts.js";
import { clockSeconds } from "../texts/times.js";
import { field } from "../elements/field.js";
/** @import { Change, Seen } from "./diagnostics_run.js" */

const SHOWN_CHANGES = 30;

/**
 * @param {Seen} seen @param {number} left_out @param {string} filter @param {(filter: string) => void} setFilter
 */
export function beliefList({ beliefs, changes }, left_out, filter, setFilter) {
  const fits = fitting(filter);
  const changed = changes.filter(({ text }) => fits(text)).slice(0, SHOWN_CHANGES);
  const believed = beliefs.filter(fits);
  return html`${filterField("belief-filter", t("mind.filter.beliefs"), filter, setFilter)}
    ${changed.length
      ? html`<h3>${t("mind.changes")}</h3>
          <ul class="changes" tabindex="0" aria-label=${t("mind.changes")}>${repeat(changed, ({ id }) => id, change)}</ul>`
      : html`<p class="hint">${t(changes.length ? "mind.filter.nothing" : "mind.changes.none")}</p>`}
    <details>
      <summary>${t("mind.beliefs.all", { count: believed.length })}</summary>
      <ul class="beliefs">${believed.map((text) => html`<li><code translate="no">${text}</code></li>`)}</ul>
      ${left_out ? html`<p class="hint">${t("mind.beliefs.more", { count: left_out })}</p>` : nothing}
    </details>`;
}

/** @param {Change} change */
function change({ came, text, at }) {
  return html`<li class=${came ? "came" : "went"}>
    <span class="sign" aria-hidden="true">${came ? "+" : "−"}</span>
    <span class="unseen">${t(came ? "mind.came" : "mind.went")}</span>
    <code translate="no">${text}</code>
    <time datetime=${at}>${clockSeconds(at)}</time>
  </li>`;
}

/** Every word of the filter somewhere in the text. @param {string} filter */
export function fitting(filter) {
  const words = filter.toLowerCase().split(/\s+/).filter(Boolean);
  return (/** @type {string} */ text) => words.every((word) => text.toLowerCase().includes(word));
}

/** @param {string} name @param {string} label @param {string} value @param {(value: string) => void} set */
export const filterField = (name, label, value, set) =>
  field(
    { name, label },
    ({ id }) => html`<input id=${id} type="search" autocomplete="off" spellcheck="false" .value=${value}
      @input=${(/** @type {InputEvent} */ event) => set(/** @type {HTMLInputElement} */ (event.target).value)} />`,
  );
