/** Where an order stands: its two ends, a sentence, what comes next, when, and how far it has come. */
import { html, nothing } from "lit";
import { arrivalOf, arrivalText, whyUnknown } from "../orders/arrival.js";
import { hasEnded, isMyTurn, nextSentence, stages, stateSentence } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { helpWords } from "../elements/field.js";
import { icon } from "../elements/icon.js";
/** @import { CampusMap, Order } from "../../types/api_types.ts" */

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

/** When the letter arrives: an interval, never a countdown; or what is waited for until that is known. @param {Order} order @param {CampusMap} map */
export function arrivalWindow(order, map) {
  const arrival = arrivalOf(order, serverNow());
  if (!arrival) return nothing;
  const late = arrival.late ? html`<span class="remark">${t("window.past")}</span>` : nothing;
  if (!arrival.window) return html`<p class="window"><span class="of">${t("window.none")}</span> <span class="remark">${whyUnknown(order, map)}</span> ${late}</p>`;
  return html`<p class="window">
    <span class="of">${t("window.label", { post: titleOf(map, order.to_post) })}</span>
    <strong>${arrivalText(order, serverNow())}</strong>
    ${late} ${arrival.assumed ? html`<span class="remark">${t("window.assumed")}</span>` : nothing}
  </p>`;
}
