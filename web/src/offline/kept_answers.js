/**
 * Answers of the service kept for use offline, as `isKeptOffline` names them. Asked first is always the
 * service. Each question takes the store that it found when it was asked: once that was deleted, since another person may
 * be here, what is still put there is gone as well.
 */
import { aboutMe, aboutOrder, anyList, isList, isMe, isOrder, isPublic } from "../service/api.js";
import { LINKS } from "./kept_link.js";
import { keepList, keepOwn, keptList } from "./running_orders.js";

/** @import { Order } from "../../types/api_types.ts" */
/** An order event and the person of the page that received it. @typedef {{order: Order, person_id: string}} Heard */

const PERSONAL = "answers";
const PUBLIC = "public answers";
const PATIENCE_MS = 4_000;

/** Another person may be here: nothing personal stays. */
export const forgetAll = () => Promise.all([PERSONAL, LINKS].map((name) => caches.delete(name)));

/** @param {FetchedEvent} event @returns {Promise<Response>} */
export async function answer(event) {
  const { request } = event;
  const url = new URL(request.url);
  const store = storeOf(url);
  const asked = fetch(request);
  event.waitUntil(asked.then((fresh) => keep(store, request, fresh.clone())).catch(() => undefined));
  return inTime(asked, async () => keptFor(await store, url, request));
}

/** Ask and keep the answer. @param {URL} url @param {AbortSignal} [signal] @returns {Promise<boolean>} whether there is one */
export async function fetchAndKeep(url, signal) {
  const request = new Request(url, { signal });
  const store = storeOf(url);
  const fresh = await fetch(request);
  await keep(store, request, fresh);
  return fresh.ok;
}

/** An order with its code, for a robot that waits where there is no network: fetched while there is one. @param {string} id */
export const keepOrder = (id) => fetchAndKeep(aboutOrder(id));

/** @param {unknown} told @returns {told is Heard} */
export const isHeard = (told) => typeof told === "object" && told !== null && "order" in told;

/** A page that is still open may be of a person who has left. @param {Heard} heard */
export async function keepHeard({ order, person_id }) {
  const cache = await caches.open(PERSONAL);
  const me = await cache.match(aboutMe(), { ignoreVary: true });
  if ((await me?.json())?.id === person_id) await keepOwn(cache, order);
}

/** @param {URL} url */
export const isKept = async (url) => Boolean(await (await storeOf(url)).match(url, { ignoreVary: true }));

/** @param {URL} url */
const storeOf = (url) => caches.open(isPublic(url) ? PUBLIC : PERSONAL);

/** Return the kept answer where the service gives none, or not soon.
 * @param {Promise<Response>} asked @param {() => Promise<Response | undefined>} kept */
async function inTime(asked, kept) {
  const patience = new Promise((resolve) => setTimeout(resolve, PATIENCE_MS));
  try {
    const fresh = await Promise.race([asked, patience]);
    if (fresh) return asked;
  } catch {
    // What is kept answers, or the same failure.
  }
  return (await kept()) ?? asked;
}

/** @param {Cache} cache @param {URL} url @param {Request} request */
async function keptFor(cache, url, request) {
  if (!isList(url)) return cache.match(request, { ignoreVary: true });
  return (await cache.match(anyList())) && keptList(cache, url);
}

/** @param {Promise<Cache>} store @param {Request} request @param {Response} fresh */
async function keep(store, request, fresh) {
  const url = new URL(request.url);
  // No one is signed in, as for guests by a link.
  if (fresh.status === 401 && !isPublic(url)) return caches.delete(PERSONAL);
  const cache = isMe(url) ? await storeFor(await store, request, fresh.clone()) : await store;
  if (!fresh.ok) return void (await cache.delete(request));
  if (isOrder(url)) return keepOwn(cache, await fresh.json());
  if (!isList(url)) return cache.put(request, fresh);
  await keepList(cache, url, await fresh.json());
  await cache.put(anyList(), new Response());
}

/** Nothing is left of anybody who was signed in here before. @param {Cache} cache @param {Request} request @param {Response} me */
async function storeFor(cache, request, me) {
  const before = await cache.match(request, { ignoreVary: true });
  if (!before || !me.ok || (await before.json()).id === (await me.json()).id) return cache;
  await forgetAll();
  return caches.open(PERSONAL);
}
