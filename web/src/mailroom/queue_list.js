/** Orders as a list: where each stands, why it waits, and what can be done with it. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { arrivalOf, arrivalText, isLate } from "../orders/arrival.js";
import { followPage, robotPage } from "../service/links.js";
import { since, whyItWaits } from "./mailroom_words.js";
import { hasEnded } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago, dayAndTime } from "../texts/times.js";
import { icon, lateMark } from "../elements/icon.js";
/** @import { CampusMap, Order } from "../../types/api_types.ts" */

/**
 * @param {Order[]} orders @param {CampusMap} map
 * @param {(order: Order) => string} whose what stands for its people
 * @param {((order: Order) => void) | null} act null: on a wall, where nothing can be done
 */
export const queueList = (orders, map, whose, act) => html`<ul class="queue">
  ${repeat(orders, ({ id }) => id, (order) => html`<li class=${order.state}>
    <div class="what">
      <div class="way">
        <strong>${titleOf(map, order.from_post)}${icon("arrow")}<span class="unseen">→</span>${titleOf(map, order.to_post)}</strong>
        <span class="badge ${order.state}">${t(`badge.${order.state}`)}</span>${isLate(order, serverNow()) ? lateMark() : nothing}
      </div>
      ${act ? html`<a href=${followPage(order.id)}>${whose(order)}</a>` : html`<span>${whose(order)}</span>`}
      ${act && order.description ? html`<bdi class="hint">${order.description}</bdi>` : nothing}
    </div>
    <div class="why-now"><bdi>${hasEnded(order) ? order.why : whyItWaits(order, map)}</bdi>${priorityMark(order)}</div>
    <div class="when">
      ${robotOf(order, act !== null)}<span>${age(order)}</span>
      ${arrives(order)}
    </div>
    ${act ? html`<button type="button" class="act" @click=${() => act(order)}>${t("mailroom.act")}<span class="unseen">: ${whose(order)}</span></button>` : nothing}
  </li>`)}
</ul>`;

/** @param {Order} order */
function priorityMark({ priority }) {
  if (priority === "normal") return nothing;
  return html` <span class="mark ${priority}">${t(`mailroom.priority.${priority}`)}</span>`;
}

/** @param {Order} order */
function arrives(order) {
  const arrival = arrivalOf(order, serverNow());
  if (!arrival) return nothing;
  const window = arrivalText(order, serverNow());
  return html`<span>${arrival.window ? t("mailroom.window", { window }) : window}</span>`;
}

/** @param {Order} order @param {boolean} linked */
function robotOf({ robot }, linked) {
  if (!robot) return nothing;
  const title = t("robot.name", { name: robot.name });
  return html`<span>${linked ? html`<a href=${robotPage(robot.name)}>${title}</a>` : title}</span>`;
}

/** @param {Order} order */
function age(order) {
  const now_ms = serverNow();
  return hasEnded(order) ? dayAndTime(order.updated_at, now_ms) : ago(since(order), now_ms);
}
