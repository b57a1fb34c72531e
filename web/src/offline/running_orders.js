/**
 * A person's own orders that go on, kept one by one with the code for what its person does next. Lists are not kept: any
 * list is answered from these orders.
 */
import { aboutCode, aboutOrder, isOrder } from "../service/api.js";
import { hasEnded } from "../orders/order_words.js";
/** @import { Order, Page } from "../../types/api_types.ts" */

/** Of more, the first are those whose robots come first. */
const CODES_AT_MOST = 10;
const ROLES = { sent: "sender", coming: "recipient" };

/** Keep the orders in progress; remove those that have ended. @param {Cache} cache @param {URL} url @param {Page<Order>} page */
export async function keepList(cache, url, page) {
  const [running, others] = [page.items.filter(isOwnAndOpen), page.items.filter((order) => !isOwnAndOpen(order))];
  const over = isWhole(url, page) ? await missingIn(cache, url, running) : [];
  await Promise.all([...others, ...over].map(({ id }) => forgetOrder(cache, id)));
  await Promise.all(running.map((order) => cache.put(aboutOrder(order.id), Response.json(order))));
  for (const order of running.sort(soonestFirst).slice(0, CODES_AT_MOST)) await keepCode(cache, order);
}

/** @param {Cache} cache @param {Order} order */
export async function keepOwn(cache, order) {
  if (!isOwnAndOpen(order)) return forgetOrder(cache, order.id);
  await cache.put(aboutOrder(order.id), Response.json(order));
  await keepCode(cache, order);
}

/** @param {Cache} cache @param {URL} url what is asked for @returns {Promise<Response>} */
export async function keptList(cache, { searchParams }) {
  const [role, state] = ["role", "state"].map((name) => searchParams.get(name) ?? "all");
  const items = (await keptOrders(cache))
    .filter((order) => isIn(role, order) && (["all", "open"].includes(state) || order.state === state))
    .sort((one, other) => Date.parse(other.created_at) - Date.parse(one.created_at));
  return Response.json({ items: items.slice(0, Number(searchParams.get("limit") ?? items.length)), next: null, only_running: true });
}

/** @param {Cache} cache @returns {Promise<Order[]>} */
async function keptOrders(cache) {
  const kept = await Promise.all((await cache.keys()).filter(({ url }) => isOrder(new URL(url))).map((one) => cache.match(one)));
  return Promise.all(kept.flatMap((order) => order?.json() ?? []));
}

/** True if the list holds every order in progress of one role. @param {URL} url @param {Page<Order>} page */
const isWhole = ({ searchParams }, page) => searchParams.get("state") === "open" && (searchParams.get("role") ?? "all") in ROLES && !page.next;

/** Kept orders that are no longer in progress. @param {Cache} cache @param {URL} url @param {Order[]} running */
async function missingIn(cache, { searchParams }, running) {
  const listed = new Set(running.map(({ id }) => id));
  const role = searchParams.get("role") ?? "all";
  return (await keptOrders(cache)).filter((order) => isIn(role, order) && !listed.has(order.id));
}

/** @param {string} role @param {Order} order */
const isIn = (role, { my_role }) => role === "all" || my_role === ROLES[/** @type {"sent" | "coming"} */ (role)];

/** Those that a robot was found for, then those that wait longest. @param {Order} one @param {Order} other */
const soonestFirst = (one, other) =>
  Number(other.robot !== null) - Number(one.robot !== null) || Date.parse(one.created_at) - Date.parse(other.created_at);

/** The code for what its person does next; one for what is done would only mislead. @param {Cache} cache @param {Order} order */
async function keepCode(cache, { id, my_code }) {
  const { code, picture } = aboutCode(id);
  const before = await cache.match(code, { ignoreVary: true });
  if (before && (await before.json()).purpose === my_code && (await cache.match(picture, { ignoreVary: true }))) return;
  await Promise.all([cache.delete(code), cache.delete(picture)]);
  if (my_code) await Promise.all([code, picture].map((url) => fetchInto(cache, url)));
}

/** @param {Cache} cache @param {URL} url */
async function fetchInto(cache, url) {
  const fresh = await fetch(url);
  if (fresh.ok) await cache.put(url, fresh);
}

/** @param {Order} order */
const isOwnAndOpen = (order) => order.my_role !== "dispatcher" && !hasEnded(order);

/** The order and its code. @param {Cache} cache @param {string} id */
async function forgetOrder(cache, id) {
  const { pathname } = aboutOrder(id);
  const kept = (await cache.keys()).filter(({ url }) => new URL(url).pathname.startsWith(pathname));
  await Promise.all(kept.map((request) => cache.delete(request)));
}
