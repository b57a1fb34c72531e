/** One order in a list: what, between where, how it stands; the whole card leads to its page. */
import { html, nothing } from "lit";
import { followPage } from "../service/links.js";
import { arrivalText, isLate } from "./arrival.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { icon, lateMark } from "../elements/icon.js";
/** @import { CampusMap, Order } from "../../types/api_types.ts" */

/** @param {Order} order @param {CampusMap} map @param {unknown} [action] something to press beside it */
export function orderCard(order, map, action = nothing) {
  const other = order.my_role === "recipient" ? t("mail.from", { name: order.sender.name }) : t("mail.to", { name: order.recipient.name });
  return html`<li class="order">
    <a class="row" href=${followPage(order.id)}>
      <span class="badge ${order.state}">${t(`badge.${order.state}`)}</span>${isLate(order, serverNow()) ? lateMark() : nothing}
      <span class="who">${order.description ? html`<bdi>${order.description}</bdi>` : other}</span>
      <span class="ends">${titleOf(map, order.from_post)}${icon("arrow")}<span class="unseen">→</span>${titleOf(map, order.to_post)}</span>
      <span class="when">${order.description ? html`${other} · ` : nothing}<span>${when(order)}</span></span>
    </a>
    ${action}
  </li>`;
}

/** The arrival while it is ahead, the day afterwards. @param {Order} order */
const when = (order) => arrivalText(order, serverNow()) || dayAndTime(order.updated_at, serverNow());
