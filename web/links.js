/** Where each page is. @import { Order, WantedOrder } from "./api_types.ts" */

export const PAGES = { order: "/", mail: "/mail.html", notices: "/notices.html" };

/** @param {string} order_id */
export const followPage = (order_id) => `/follow.html?order=${encodeURIComponent(order_id)}`;

/** The order page, filled in like an earlier order. @param {Order} order */
export const repeatPage = (order) =>
  "/?" +
  new URLSearchParams({
    from_post: order.from_post,
    to_post: order.to_post,
    recipient: order.recipient.email,
    description: order.description ?? "",
  });

/** What `repeatPage` asked for. @param {string} search @returns {Partial<WantedOrder>} */
export const wantedFrom = (search) => Object.fromEntries(new URLSearchParams(search));

/** @param {string} search the order that a follow page is about; null if the address names none */
export const orderFrom = (search) => new URLSearchParams(search).get("order");

/** Told to delegates, who may not follow the order: the mail that they got has a link of their own. */
const OF_DELEGATES = ["delegated", "delegation_over"];

/** What a notice leads to. @param {import("./api_types.ts").Notice} notice */
export const pageOf = ({ order_id, kind }) => (order_id && !OF_DELEGATES.includes(kind) ? followPage(order_id) : null);
