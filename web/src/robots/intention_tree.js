/**
 * Intentions of a robot as a tree: each intention from its first cause down to what it is doing, with the plan of each
 * goal and why that one; and why it does not go on.
 */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { hasText, t } from "../texts/texts.js";
import { TreeKeys } from "../elements/tree_keys.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Because, Diagnostics, IntentionView, Means, NotChosen } from "../../types/api_types.ts" */

export class IntentionTree extends PageElement {
  static properties = { insight: { attribute: false } };

  constructor() {
    super();
    /** @type {Diagnostics | null} */
    this.insight = null;
    new TreeKeys(this);
  }

  render() {
    if (!this.insight) return nothing;
    const { intentions, events, left_out } = this.insight;
    return html`${intentions.length
        ? html`<ul role="tree" class="intentions" aria-label=${t("mind.title")}>${repeat(intentions, ({ number }) => number, intention)}</ul>`
        : html`<p class="empty">${t("mind.intentions.none")}</p>`}
      ${left_out.intentions ? html`<p class="hint">${t("mind.intentions.more", { count: left_out.intentions })}</p>` : nothing}
      ${events.length
        ? html`<h3>${t("mind.events")}</h3>
            <ul class="events">${events.map((event) => html`<li><code translate="no">${event}</code></li>`)}</ul>`
        : nothing}`;
  }
}

/** @param {IntentionView} told */
function intention({ number, state, because, stack, beside }) {
  const how = hasText(`mind.state.${state}`) ? t(`mind.state.${state}`) : state;
  return html`<li role="treeitem" aria-expanded="true" tabindex="-1">
    <div class="line turns">${t("mind.intention", { number })} <span class="badge ${state}">${how}</span></div>
    <p class="because">${becauseText(because)}</p>
    ${beside.length ? html`<p class="hint">${t("mind.beside", { numbers: beside.join(", ") })}</p>` : nothing}
    <div role="group">${stack.length ? branch(stack, 0) : nothing}</div>
  </li>`;
}

/** A goal, and within it why its plan and the goal that it needs. @param {Means[]} stack @param {number} depth @returns {unknown} */
function branch(stack, depth) {
  const { goal, plan, place, step, relevant, passed_over } = stack[depth];
  const isLast = depth === stack.length - 1;
  const hasMore = !isLast || passed_over.length > 0;
  return html`<div role="treeitem" class="goal-item ${isLast ? "now" : ""}" aria-expanded=${hasMore ? "true" : nothing} tabindex="-1">
    <div class="line ${hasMore ? "turns" : ""}"><code class="goal" translate="no">${goal}</code></div>
    <p class="hint">${t("mind.by_plan")} <code translate="no">${place ?? plan}</code>${
      step ? html` · ${t(isLast ? "mind.next" : "mind.then")} <code translate="no">${step}</code>` : nothing
    }</p>
    ${!passed_over.length && relevant === 1 ? html`<p class="hint">${t("mind.only_plan")}</p>` : nothing}
    ${hasMore
      ? html`<div role="group">${passed_over.length ? whyThisPlan(passed_over) : nothing} ${isLast ? nothing : branch(stack, depth + 1)}</div>`
      : nothing}
  </div>`;
}

/** @param {NotChosen[]} passed_over */
const whyThisPlan = (passed_over) => html`<div role="treeitem" class="why" aria-expanded="false" tabindex="-1">
  <div class="line turns">${t("mind.why_this_plan")}</div>
  <ul role="group">${passed_over.map((other) => html`<li role="treeitem" tabindex="-1">${notChosenText(other)}</li>`)}</ul>
</div>`;

/** @param {NotChosen} other */
const notChosenText = ({ plan, why }) => html`${t("mind.not_chosen")} <code translate="no">${plan}</code>: <span translate="no">${why}</span>`;

/** @param {NotChosen} other */
export const notChosen = (other) => html`<li>${notChosenText(other)}</li>`;

/** Why it does not go on, in this page's language; of what the catalogue does not know, the robot's own sentence. @param {Because} because */
function becauseText({ kind, sentence, goal, plan, what, left_s, needed_for }) {
  const key = `mind.because.${kind.replaceAll(/[ -]/g, "_")}`;
  if (!hasText(key)) return sentence;
  const seconds = Math.ceil(left_s ?? 0);
  const until = left_s !== null && left_s !== undefined && kind !== "moment" ? t("mind.because_until", { seconds }) : "";
  const needed = (needed_for ?? []).map((goal) => t("mind.because_needed", { goal })).join("");
  return `${t(key, { goal, plan: plan ?? "", what: what ?? "", seconds })}${until}${needed}.`;
}

customElements.define("intention-tree", IntentionTree);
