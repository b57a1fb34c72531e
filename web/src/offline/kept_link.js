/**
 * The answer to a link in a mail, kept for use offline. It is found again with the same link alone:
 * of the link itself only a hash is kept.
 */
import { ApiProblem } from "../service/api.js";
import { hasEnded } from "../orders/order_words.js";
/** @import { Order } from "../../types/api_types.ts" */
/** @typedef {"order" | "code"} What */

/** The store. */
export const LINKS = "links";
const PATIENCE_MS = 4_000;
/** No link is good for longer; the service says so itself while it is asked. */
const KEPT_MS = 14 * 86_400_000;
const KEPT_AT = "Kept-At";

/** The answer; what is kept where there is none, or not soon.
 * @template T @param {string} token @param {What} what @param {() => Promise<T>} ask
 * @returns {Promise<{answer: T, isKept: boolean}>} */
export async function askedOrKept(token, what, ask) {
  const asked = ask().then((answer) => ({ answer, isKept: false }));
  asked.then(({ answer }) => keep(token, what, answer), (failure) => (isOver(failure) ? forget(token, what) : undefined)).catch(() => undefined);
  const late = new Promise((resolve) => setTimeout(resolve, PATIENCE_MS));
  const failure = await Promise.race([asked, late]).then((inTime) => (inTime ? null : "late"), (failed) => failed);
  if (!failure || failure instanceof ApiProblem) return asked;
  const kept = await keptFor(token, what).catch(() => undefined);
  return kept ? { answer: kept, isKept: true } : asked;
}

/** @param {unknown} failure */
const isOver = (failure) => failure instanceof ApiProblem && [401, 403, 404].includes(failure.status);

/** Without its order there is no code. @param {string} token @param {What} what */
async function forget(token, what) {
  const cache = await caches.open(LINKS);
  await cache.delete(await placeOf(token, "code"));
  if (what === "order") await cache.delete(await placeOf(token, "order"));
}

/** @param {string} token @param {What} what @param {unknown} answer */
async function keep(token, what, answer) {
  const cache = await caches.open(LINKS);
  if (what === "order") {
    const order = /** @type {Order} */ (answer);
    if (hasEnded(order)) return forget(token, "order");
    const code = await keptFor(token, "code");
    if (code && code.purpose !== order.my_code) await forget(token, "code");
  }
  await cache.put(await placeOf(token, what), Response.json(answer, { headers: { [KEPT_AT]: `${Date.now()}` } }));
}

/** @param {string} token @param {What} what */
async function keptFor(token, what) {
  const cache = await caches.open(LINKS);
  await dropOld(cache);
  return (await cache.match(await placeOf(token, what)))?.json();
}

/** Of links that were never opened again. @param {Cache} cache */
async function dropOld(cache) {
  for (const request of await cache.keys()) {
    const kept_at = Number((await cache.match(request))?.headers.get(KEPT_AT));
    if (Date.now() - kept_at > KEPT_MS) await cache.delete(request);
  }
}

/** @param {string} token @param {What} what */
async function placeOf(token, what) {
  const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", new TextEncoder().encode(token)));
  return new URL(`/${LINKS}/${Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join("")}/${what}`, location.origin);
}
