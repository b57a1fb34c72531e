/** Who has had the letter, from when to when, and how each hand-over was confirmed. */
import { html, nothing } from "lit";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { dayAndTime } from "../times.js";
/** @import { Custody, Order } from "../api_types.ts" */

/** Nothing as long as it has never changed hands. @param {Order} order */
export function orderCustody(order) {
  if (order.custody.length < 2) return nothing;
  return html`<section class="card" aria-labelledby="custody-title">
    <h2 id="custody-title">${t("follow.custody.title")}</h2>
    <ol class="custody">
      ${order.custody.map(
        (link) => html`<li class=${link.to ? "" : "now"}>
          <span class="what">${nameOf(order, link.holder, link.name)}</span>
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

/** @param {Custody} link */
function span({ from, to }) {
  const since = dayAndTime(from, serverNow());
  return to ? t("follow.custody.span", { from: since, to: dayAndTime(to, serverNow()) }) : t("follow.custody.since", { from: since });
}

/** @param {Order} order @param {Custody} link */
function howText(order, { how, confirmed_by, confirmed_by_name, signed }) {
  const name = confirmed_by ? nameOf(order, confirmed_by, confirmed_by_name) : "";
  const confirmed = t(`follow.custody.how.${how}`, { name });
  return signed ? t("follow.custody.signed", { confirmed }) : confirmed;
}
