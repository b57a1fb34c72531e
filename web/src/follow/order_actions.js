/** Actions on a letter, by its state and this person's role. Dispatches the changed order as a `changed` event. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { repeatPage } from "../service/links.js";
import { hasEnded, isAboard } from "../orders/order_words.js";
import { t } from "../texts/texts.js";
import "../elements/ask_first.js";
import { icon } from "../elements/icon.js";
/** @import { Order } from "../../types/api_types.ts" */
/** @import { Words } from "../elements/ask_first.js" */

/** @typedef {(order: Order) => void} Changed */

/** @param {Order} order @param {Changed} changed */
export const orderActions = (order, changed) => html`<div class="choices">
  ${order.my_role === "sender" && hasEnded(order)
    ? html`<a class="button" href=${repeatPage(order)}>${icon("repeat")}${t("follow.again")}</a>`
    : nothing}
  ${mayRefuse(order) ? asking(notNowWords(order), () => api.sayNotNow(order.id), changed) : nothing}
  ${order.can_cancel ? asking(isAboard(order) ? bringBackWords() : cancelWords(), () => api.cancelOrder(order.id), changed) : nothing}
</div>`;

/** @param {Order} order */
export const mayRefuse = (order) => order.my_role === "recipient" && isAboard(order) && !order.return_requested;

/** @param {Words} words @param {() => Promise<Order>} act @param {Changed} changed */
export const asking = (words, act, changed) => html`<ask-first .words=${words} .act=${act}
  @done=${(/** @type {CustomEvent<Order>} */ { detail }) => changed(detail)}></ask-first>`;

/** @param {Order} order @returns {Words} */
export const notNowWords = ({ sender }) => ({
  open: t("follow.not_now.open"),
  title: t("follow.not_now.title"),
  body: t("follow.not_now.body", { sender: sender.name }),
  yes: t("follow.not_now.yes"),
  no: t("follow.not_now.no"),
});

/** @returns {Words} */
const cancelWords = () => ({
  open: t("cancel.open"),
  title: t("cancel.title"),
  body: t("cancel.body"),
  yes: t("cancel.yes"),
  no: t("cancel.no"),
});

/** @returns {Words} */
const bringBackWords = () => ({
  open: t("bring_back.open"),
  title: t("bring_back.title"),
  body: t("bring_back.body"),
  yes: t("bring_back.yes"),
  no: t("bring_back.no"),
});
