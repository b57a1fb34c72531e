/** Where an order stands: its two ends, a sentence, what comes next, when, and how far it has come. */
import { html, nothing } from "lit";
import { hasEnded, isMyTurn, nextSentence, stages, stateSentence } from "../order_words.js";
import { titleOf } from "../posts.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { windowText } from "../times.js";
import { helpWords } from "./field.js";
import { icon } from "./icon.js";
/** @import { CampusMap, Order } from "../api_types.ts" */

/** @param {Order} order @param {CampusMap} map */
export const orderStanding = (order, map) => html`<section class="standing ${order.state}">
  <p class="ends">${titleOf(map, order.from_post)}${icon("arrow")}<span class="unseen">→</span>${titleOf(map, order.to_post)}</p>
  <h1 aria-live="polite">${stateSentence(order, map, serverNow())}</h1>
  <p class="next">${nextSentence(order, map, serverNow())}</p>
  ${hasEnded(order) || isMyTurn(order) ? nothing : arrivalWindow(order, map)} ${way(order)} ${hasEnded(order) ? nothing : helpWords("meeting")}
</section>`;

/** @param {Order} order */
function way(order) {
  const all = stages(order);
  const step = all.findIndex(({ now }) => now) + 1;
  const label = step ? t("follow.steps", { step, steps: all.length, name: t(`stage.${all[step - 1].name}`) }) : nothing;
  if (!all.length) return nothing;
  return html`<ol class="stages" aria-label=${label}>
    ${all.map(({ name, done, now }) => html`<li class=${done ? "done" : now ? "now" : ""}><span>${t(`stage.${name}`)}</span></li>`)}
  </ol>`;
}

/** When the letter arrives: an interval, never a countdown. @param {Order} order @param {CampusMap} map */
export function arrivalWindow({ window, to_post }, map) {
  if (!window) return html`<p class="window">${t("window.none")}</p>`;
  const late = Date.parse(window.to) < serverNow();
  return html`<p class="window">
    <span class="of">${t("window.label", { post: titleOf(map, to_post) })}</span>
    <strong>${windowText(window, serverNow())}</strong>
    ${late ? html`<span class="remark">${t("window.past")}</span>` : nothing}
    ${window.assumed ? html`<span class="remark">${t("window.assumed")}</span>` : nothing}
  </p>`;
}
