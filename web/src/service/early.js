/**
 * Makes every page's first requests while the other modules are still on their way; what its address does not tell
 * is on its way already, by the page's head (make_pages.py). A page takes each answer once; a second call asks anew.
 */
import * as api from "./api.js";
import { orderFrom } from "./links.js";
import { loadMap } from "./posts.js";
import { fetchTexts } from "../texts/texts.js";
/** @import { Order, Page } from "../../types/api_types.ts" */

const LANGUAGE = "language";
const BY_LINK = "/one-order.html";
const WITH_MAP = ["/", "/mail.html", "/follow.html", BY_LINK];
/** Enough orders for those in progress and the latest recipients. */
const NEWEST = { limit: 6 };

/** The language that was chosen last on this device: known before anybody says who is here. */
const language = localStorage.getItem(LANGUAGE) ?? navigator.languages[0]?.split("-")[0] ?? "en";

const about = api.about();
/** A person who comes by a link need not be signed in. */
const me = location.pathname === BY_LINK ? Promise.resolve(null) : api.me();
fetchTexts(language).catch(() => undefined);
/** Asked before it is known who is here: no one is refused it. @type {Promise<Page<Order>> | null} */
let orders = location.pathname === "/" ? api.orders("all", NEWEST) : null;
const order_id = orderFrom(location.search);
/** @type {Promise<Order> | null} */
let followed = location.pathname === "/follow.html" && order_id ? api.order(order_id) : null;
const map = WITH_MAP.includes(location.pathname) ? loadMap() : null;
// The caller that needs an answer gets its failure: a rejection must not be reported as unhandled before.
for (const answer of [about, me, orders, followed, map]) answer?.catch(() => undefined);

/** The first answers, for the page that is being opened. */
export const first = () => Promise.all([about, me]);

/** My newest orders. */
export function newestOrders() {
  const answer = orders ?? api.orders("all", NEWEST);
  orders = null;
  return answer;
}

/** The order that the page was opened for. @param {string} id @returns {Promise<Order>} */
export async function followedOrder(id) {
  const asked = followed;
  followed = null;
  const answer = await asked;
  return answer?.id === id ? answer : api.order(id);
}

/** @param {string} chosen */
export const rememberLanguage = (chosen) => localStorage.setItem(LANGUAGE, chosen);
