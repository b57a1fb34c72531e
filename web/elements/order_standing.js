/** Where an order stands: its two ends, a sentence, what comes next, when, and how far it has come. */
import { html, nothing } from "lit";
import { hasEnded, isMyTurn, nextSentence, stages, stateSentence } from "../order_words.js";
import { titleOf } from "../posts.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { arrivalWindow } from "./arrival_window.js";
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
