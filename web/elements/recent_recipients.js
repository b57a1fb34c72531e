/** Those I sent something last, each a tap away. */
import { html, nothing } from "lit";
import { titleOf } from "../posts.js";
import { t } from "../texts.js";
/** @import { CampusMap, Order } from "../api_types.ts" */

const RECENT = 3;

/** @param {CampusMap} map @param {Order[]} sent newest first @param {(order: Order) => void} repeat */
export function recentRecipients(map, sent, repeat) {
  const recent = newestToEach(sent);
  if (!recent.length) return nothing;
  return html`<div class="recent" role="group" aria-label=${t("order.recent")}>
    ${recent.map(
      (order) => html`<button type="button" @click=${() => repeat(order)}>
        <span>${order.recipient.name}</span><span class="unseen">, </span><small>${titleOf(map, order.to_post)}</small>
      </button>`,
    )}
  </div>`;
}

/** @param {Order[]} sent */
function newestToEach(sent) {
  const newest = new Map();
  for (const order of sent) if (!newest.has(order.recipient.email)) newest.set(order.recipient.email, order);
  return /** @type {Order[]} */ ([...newest.values()].slice(0, RECENT));
}
