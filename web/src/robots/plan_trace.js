/** The activity log of a robot's agent, newest first: chosen plans, actions, beliefs, dropped goals. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { t } from "../texts/texts.js";
import { filterField, fitting } from "./belief_list.js";
import { notChosen } from "./intention_tree.js";
/** @import { NumberedLine, Seen } from "./diagnostics_run.js" */

const KINDS = ["chose", "did", "believed", "forgot", "gave_up"];
const SHOWN = 150;

/**
 * @param {Seen} seen @param {{text: string, kind: string}} filter
 * @param {(change: {traceFilter?: string, kind?: string}) => void} set
 */
export function planTrace({ lines, missed, left_out }, filter, set) {
  const fits = fitting(filter.text);
  const found = lines.filter((line) => (!filter.kind || line.kind === filter.kind) && fits(textOf(line)));
  return html`<div class="filters">
      ${filterField("trace-filter", t("mind.filter.trace"), filter.text, (text) => set({ traceFilter: text }))}
      ${kinds(filter.kind, (kind) => set({ kind }))}
    </div>
    <p class="hint">${t("mind.trace.found", { found: found.length, all: lines.length })}${
      missed || left_out ? ` ${t("mind.trace.missed", { lines: left_out, times: missed })}` : nothing
    }</p>
    <ol class="lines" tabindex="0" aria-label=${t("mind.trace")}>
      ${repeat(found.slice(0, SHOWN), ({ id }) => id, traceLine)}
    </ol>
    ${found.length > SHOWN ? html`<p class="hint">${t("mind.trace.older", { count: found.length - SHOWN })}</p>` : nothing}`;
}

/** @param {string} chosen @param {(kind: string) => void} set */
const kinds = (chosen, set) => html`<div class="field">
  <label for="trace-kind">${t("mind.filter.kind")}</label>
  <select id="trace-kind" .value=${chosen}
    @change=${(/** @type {Event} */ event) => set(/** @type {HTMLSelectElement} */ (event.target).value)}>
    <option value="">${t("mind.kind_any")}</option>
    ${KINDS.map((kind) => html`<option value=${kind}>${t(`mind.kind.${kind}`)}</option>`)}
  </select>
</div>`;

/** The text that the filter searches. @param {NumberedLine} line */
const textOf = ({ text, plan, place, cycle }) => `${cycle} ${text} ${plan ?? ""} ${place ?? ""}`;

/** @param {NumberedLine} line */
function traceLine({ cycle, kind, text, plan, place, passed_over }) {
  return html`<li class=${kind}>
    <span class="cycle"><span class="unseen">${t("mind.cycle")} </span>${cycle}</span>
    <span class="kind">${t(`mind.kind.${kind}`)}</span>
    <code translate="no">${text}</code>
    ${kind === "chose" ? html`<span class="hint">${plan ? t("mind.chose_plan") : t("mind.no_plan")} <code translate="no">${place ?? plan ?? ""}</code></span>` : nothing}
    ${passed_over?.length
      ? html`<details class="why"><summary>${t("mind.why_this_plan")}</summary><ul>${passed_over.map(notChosen)}</ul></details>`
      : nothing}
  </li>`;
}
