/** Sender, recipient, contents, order number and chain of custody. */
import { html, nothing } from "lit";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
import { address } from "../elements/address.js";
/** @import { Custody, Order, Party } from "../../types/api_types.ts" */

/** @param {Order} order */
export const orderDetails = (order) => html`<section class="card" aria-labelledby="details-title">
  <h2 id="details-title">${t("follow.details")}</h2>
  <dl class="details">
    ${row("follow.sender", party(order.sender, order.my_role === "sender"))}
    ${row("follow.recipient", party(order.recipient, order.my_role === "recipient"))}
    ${order.description ? row("follow.description", own(order.description)) : nothing}
    ${row("follow.number", html`<code>${order.id}</code>`)}
  </dl>
</section>`;

/** Text that a person has written. @param {string} words */
const own = (words) => html`<bdi>${words}</bdi>`;

/** @param {string} label @param {unknown} value */
const row = (label, value) => html`<div><dt>${t(label)}</dt><dd>${value}</dd></div>`;

/** @param {Party} person @param {boolean} isMe */
const party = ({ name, email }, isMe) =>
  html`${isMe ? t("follow.you", { name }) : own(name)}${address(email)}`;

/** From when to when, and how each hand-over was confirmed; nothing as long as it has never changed hands. @param {Order} order */
export function orderCustody(order) {
  if (order.custody.length < 2) return nothing;
  return html`<section class="card" aria-labelledby="custody-title">
    <h2 id="custody-title">${t("follow.custody.title")}</h2>
    <ol class="custody">
      ${order.custody.map(
        (link) => html`<li class=${link.to || isSaidToBeOut(link) ? "" : "now"}>
          <span class="what">${own(nameOf(order, link.holder, link.name))}</span>
          <span class="remark">${span(link)}</span>
          ${link.how ? html`<span class="remark">${howText(order, link)}</span>` : nothing}
        </li>`,
      )}
    </ol>
  </section>`;
}

/** @param {Order} order @param {string} holder @param {string | null} name */
function nameOf({ sender, recipient }, holder, name) {
  if (holder === "sender") return sender.name;
  if (holder === "recipient") return recipient.name;
  if (holder === "robot") return t("robot.name", { name: name ?? "" });
  return name ?? t(`follow.custody.holder.${holder}`);
}

/** The robot's claim counts until a dispatcher has checked it. @param {Custody} link */
const isSaidToBeOut = ({ evidence, holder }) => evidence === "claimed" && holder !== "robot";

/** @param {Custody} link */
function span({ from, to }) {
  const since = dayAndTime(from, serverNow());
  return to ? t("follow.custody.span", { from: since, to: dayAndTime(to, serverNow()) }) : t("follow.custody.since", { from: since });
}

/** @param {Order} order @param {Custody} link */
function howText(order, { how, confirmed_by, confirmed_by_name, signed, evidence }) {
  if (evidence === "claimed" || evidence === "settled") return t(`follow.custody.${evidence}`);
  const name = confirmed_by ? nameOf(order, confirmed_by, confirmed_by_name) : "";
  const said = t(`follow.custody.how.${how}`, { name });
  const confirmed = evidence === "digest" ? t("follow.custody.weaker", { confirmed: said }) : said;
  return signed ? t("follow.custody.signed", { confirmed }) : confirmed;
}
