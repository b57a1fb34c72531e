/**
 * What the service answered, kept for when it cannot be asked: one person's, what `isKeptOffline` names, of orders
 * only those that are the person's own and go on. Asked first is always the service.
 */
import { aboutCode, aboutOrder, isList, isMe, isOrder } from "../api.js";
import { hasEnded } from "../order_words.js";
/** @import { Order } from "../api_types.ts" */

const KEPT = "answers";
const PATIENCE_MS = 4_000;

/** Changes whenever somebody else may be signed in: what was asked before is not kept any more. */
let era = 0;

export async function forgetAnswers() {
  era += 1;
  await caches.delete(KEPT);
}

/** @param {FetchedEvent} event @returns {Promise<Response>} */
export async function answer(event) {
  const { request } = event;
  const asked_in = era;
  const asked = fetch(request);
  event.waitUntil(asked.then((fresh) => (era === asked_in ? keep(request, fresh.clone()) : undefined), () => undefined));
  const kept = await caches.match(request, { cacheName: KEPT, ignoreVary: true });
  if (!kept) return asked;
  const patience = new Promise((resolve) => setTimeout(resolve, PATIENCE_MS));
  return Promise.race([asked, patience.then(() => kept)]).catch(() => kept);
}

/** @param {Request} request @param {Response} fresh */
async function keep(request, fresh) {
  const url = new URL(request.url);
  if (fresh.status === 401) return forgetAnswers();
  if (isMe(url)) await forgetAnother(request, fresh.clone());
  const cache = await caches.open(KEPT);
  if (!fresh.ok) return void (await cache.delete(request));
  if (isList(url)) return keepOpen(cache, request, await fresh.json());
  if (isOrder(url)) return keepIfOpen(cache, request, fresh);
  await cache.put(request, fresh);
}

/** @param {Cache} cache @param {Request} request @param {Response} fresh */
async function keepIfOpen(cache, request, fresh) {
  const order = /** @type {Order} */ (await fresh.clone().json());
  if (!isOwnAndOpen(order)) return forgetOrder(cache, new URL(request.url));
  await cache.put(request, fresh);
  await keepCode(cache, order);
}

/** Whoever was signed in here before. @param {Request} request @param {Response} me */
async function forgetAnother(request, me) {
  const before = await caches.match(request, { cacheName: KEPT, ignoreVary: true });
  if (before && (await before.json()).id !== (await me.json()).id) await forgetAnswers();
}

/** Of a list only what goes on; what has ended is forgotten wherever it was kept.
 * @param {Cache} cache @param {Request} request @param {{items: Order[], next: string | null}} page */
async function keepOpen(cache, request, page) {
  const items = page.items.filter(isOwnAndOpen);
  const ended = page.items.filter(hasEnded).map(({ id }) => aboutOrder(id));
  await cache.put(request, Response.json({ ...page, items, next: null }));
  await Promise.all(ended.map((url) => forgetOrder(cache, url)));
  for (const order of items) await keepIfOpen(cache, new Request(aboutOrder(order.id)), Response.json(order));
}

/** An order with its code, for a robot that waits where there is no network: fetched while there is one. @param {string} id */
export const keepOrder = (id) => fetchAndKeep(aboutOrder(id));

/** The code for what its person does next; one for what is done would only mislead. @param {Cache} cache @param {Order} order */
async function keepCode(cache, { id, my_code }) {
  const { code, picture } = aboutCode(id);
  const before = await cache.match(code, { ignoreVary: true });
  if (before && (await before.json()).purpose === my_code) return;
  await Promise.all([cache.delete(code), cache.delete(picture)]);
  if (my_code) await Promise.all([fetchAndKeep(code), fetchAndKeep(picture)]);
}

/** @param {URL} url */
async function fetchAndKeep(url) {
  const asked_in = era;
  const request = new Request(url);
  const fresh = await fetch(request);
  if (era === asked_in) await keep(request, fresh);
}

/** @param {Order} order */
const isOwnAndOpen = (order) => order.my_role !== "dispatcher" && !hasEnded(order);

/** The order and its code. @param {Cache} cache @param {URL} url */
async function forgetOrder(cache, url) {
  const kept = (await cache.keys()).filter((request) => new URL(request.url).pathname.startsWith(url.pathname));
  await Promise.all(kept.map((request) => cache.delete(request)));
}
