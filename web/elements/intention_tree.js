/** What a robot intends: each intention from its first cause down to what it is doing, and why it does not go on. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { hasText, t } from "../texts.js";
/** @import { Because, Insight, IntentionTold, Means, NotChosen } from "../api_types.ts" */

/** @param {Insight} insight */
export function intentionTree({ intentions, events, left_out }) {
  return html`${intentions.length
      ? html`<ul class="intentions">${repeat(intentions, ({ number }) => number, intention)}</ul>`
      : html`<p class="empty">${t("mind.intentions.none")}</p>`}
    ${left_out.intentions ? html`<p class="hint">${t("mind.intentions.more", { count: left_out.intentions })}</p>` : nothing}
    ${events.length
      ? html`<h3>${t("mind.events")}</h3>
          <ul class="events">${events.map((event) => html`<li><code translate="no">${event}</code></li>`)}</ul>`
      : nothing}`;
}

/** @param {IntentionTold} intention */
function intention({ number, state, because, stack, beside }) {
  return html`<li>
    <details open>
      <summary>
        ${t("mind.intention", { number })}
        <span class="badge ${state}">${hasText(`mind.state.${state}`) ? t(`mind.state.${state}`) : state}</span>
      </summary>
      <p class="because">${becauseText(because)}</p>
      ${beside.length ? html`<p class="hint">${t("mind.beside", { numbers: beside.join(", ") })}</p>` : nothing}
      ${stack.length ? branch(stack, 0, number) : nothing}
    </details>
  </li>`;
}

/** A goal, and within it the goal that it needs. @param {Means[]} stack @param {number} depth @param {number} number @returns {unknown} */
function branch(stack, depth, number) {
  const { goal, plan, place, step, relevant, passed_over } = stack[depth];
  const isLast = depth === stack.length - 1;
  return html`<ul class="goals">
    <li class=${isLast ? "now" : nothing}>
      <p><code class="goal" translate="no">${goal}</code></p>
      <p class="hint">${t("mind.by_plan")} <code translate="no">${place ?? plan}</code>${
        step ? html` · ${t(isLast ? "mind.next" : "mind.then")} <code translate="no">${step}</code>` : nothing
      }</p>
      ${chosen(relevant, passed_over)}
      ${isLast ? nothing : branch(stack, depth + 1, number)}
    </li>
  </ul>`;
}

/** Why this plan. @param {number | null | undefined} relevant @param {NotChosen[]} passed_over */
function chosen(relevant, passed_over) {
  if (!passed_over.length) return relevant === 1 ? html`<p class="hint">${t("mind.only_plan")}</p>` : nothing;
  return html`<details class="why">
    <summary>${t("mind.why_this_plan")}</summary>
    <ul>${passed_over.map(notChosen)}</ul>
  </details>`;
}

/** @param {NotChosen} other */
export const notChosen = ({ plan, why }) => html`<li>${t("mind.not_chosen")} <code translate="no">${plan}</code>: <span translate="no">${why}</span></li>`;

/** Why it does not go on, in this page's language; of what the catalogue does not know, the robot's own sentence. @param {Because} because */
function becauseText({ kind, sentence, goal, plan, what, left_s, needed_for }) {
  const key = `mind.because.${kind.replaceAll(/[ -]/g, "_")}`;
  if (!hasText(key)) return sentence;
  const seconds = Math.ceil(left_s ?? 0);
  const until = left_s !== null && left_s !== undefined && kind !== "moment" ? t("mind.because_until", { seconds }) : "";
  const needed = (needed_for ?? []).map((goal) => t("mind.because_needed", { goal })).join("");
  return `${t(key, { goal, plan: plan ?? "", what: what ?? "", seconds })}${until}${needed}.`;
}
