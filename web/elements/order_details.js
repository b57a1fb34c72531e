/** Who, what, and the number to name when asking about it. */
import { html, nothing } from "lit";
import { t } from "../texts.js";
/** @import { Order, Party } from "../api_types.ts" */

/** @param {Order} order */
export const orderDetails = (order) => html`<section class="card" aria-labelledby="details-title">
  <h2 id="details-title">${t("follow.details")}</h2>
  <dl class="details">
    ${row("follow.sender", party(order.sender, order.my_role === "sender"))}
    ${row("follow.recipient", party(order.recipient, order.my_role === "recipient"))}
    ${order.description ? row("follow.description", order.description) : nothing}
    ${row("follow.number", html`<code>${order.id}</code>`)}
  </dl>
</section>`;

/** @param {string} label @param {unknown} value */
const row = (label, value) => html`<div><dt>${t(label)}</dt><dd>${value}</dd></div>`;

/** @param {Party} person @param {boolean} isMe */
const party = ({ name, email }, isMe) =>
  html`${isMe ? t("follow.you", { name }) : name}<span class="address">${email}</span>`;
