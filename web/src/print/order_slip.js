/** A slip to go with the mail: who, from where, to where, and the code for the robot or the order's page for a phone. */
import { html, nothing } from "lit";
import { pagePicture } from "../service/api.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { dayAndTime } from "../texts/times.js";
/** @import { CampusMap, Order, ShownCode } from "../../types/api_types.ts" */

/** @param {Order} order @param {CampusMap} map @param {ShownCode | null} code @param {string} link where it is followed */
export const orderSlip = (order, map, code, link) => html`<article class="slip" aria-label=${t("print.slip")}>
  <header><img src="/icons/icon.svg" alt="" width="40" height="40" /><strong>${t("app.name")}</strong></header>
  <dl>
    ${row("print.from", titleOf(map, order.from_post), own(order.sender.name))}
    ${row("print.to", titleOf(map, order.to_post), own(order.recipient.name))}
    ${order.description ? row("order.description", own(order.description)) : nothing}
    ${row("print.ordered", dayAndTime(order.created_at, serverNow()))}
    ${row("print.number", html`<code>${order.id}</code>`)}
  </dl>
  ${code ? withCode(code) : withLink(order, link)}
</article>`;

/** Text that a person has written. @param {string} words */
const own = (words) => html`<bdi>${words}</bdi>`;

/** @param {string} label @param {unknown} value @param {unknown} [more] */
const row = (label, value, more) => html`<div><dt>${t(label)}</dt><dd><strong>${value}</strong>${more ? html`<br />${more}` : nothing}</dd></div>`;

/** One picture on a slip, never two: this one is for a phone, the robot would refuse it. @param {Order} order @param {string} link */
const withLink = ({ id, state, sender }, link) => html`<figure>
  <img src=${pagePicture(id)} alt=${t("print.page_code")} width="200" height="200" />
  <figcaption>
    <strong>${t("print.page_code.for")}</strong>
    ${state === "queued" ? html`<span>${t("print.next", { sender: sender.name })}</span>` : nothing}
    <span class="link">${t("print.follow")}<br /><code>${link}</code></span>
  </figcaption>
</figure>`;

/** @param {ShownCode} code */
const withCode = ({ purpose, picture, expires_at }) => html`<figure>
  <img src=${picture} alt=${t("code.image")} width="200" height="200" />
  <figcaption>
    <strong>${t(`code.title.${purpose}`)}</strong>
    <span>${t(`code.how.${purpose}.1`)} ${t(`code.how.${purpose}.2`)}</span>
    <span>${t("code.expires", { time: dayAndTime(expires_at, serverNow()) })}</span>
  </figcaption>
</figure>`;
