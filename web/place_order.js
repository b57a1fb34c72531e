/**
 * Sending an order so that a double tap, a lost answer, a reload or no network at all is still one order: it lies in the
 * outbox, with its key, until the service has answered.
 * @import { Order, WantedOrder } from "./api_types.ts"
 * @import { KeptOrder } from "./outbox.js"
 */
import * as api from "./api.js";
import { announce, discard, inSession, isRefusal, isWaiting, keep, keptOrders, sendLater } from "./outbox.js";
import { sayKept } from "./session.js";

const TRY_AGAIN_AFTER_MS = [700, 2_500];

/** There was no answer: the order is kept, and is sent by itself when there is a network. */
export class KeptForLater extends Error {}

/** @param {WantedOrder} wanted @param {string} person_id @returns {Promise<Order>} throws KeptForLater, ApiProblem */
export async function placeOrder(wanted, person_id) {
  const kept = await keptAs(wanted, person_id);
  try {
    const order = await inSession(() => persist(() => api.placeOrder(wanted, kept.key)));
    await discard(kept.key);
    return order;
  } catch (problem) {
    if (!(problem instanceof api.NoAnswer) && !(problem instanceof api.ApiProblem)) throw problem;
    if (isRefusal(problem)) await discard(kept.key);
    if (problem instanceof api.ApiProblem && problem.status < 500) throw problem;
    sayKept(true);
    announce();
    await sendLater();
    throw new KeptForLater();
  }
}

/** The same order that waits for its answer already is that order. @param {WantedOrder} wanted @param {string} person_id @returns {Promise<KeptOrder>} */
async function keptAs(wanted, person_id) {
  const waiting = (await keptOrders(person_id)).filter(isWaiting);
  const before = waiting.find((kept) => JSON.stringify(kept.wanted) === JSON.stringify(wanted));
  if (before) return before;
  const kept = { key: crypto.randomUUID(), person_id, wanted, at: new Date().toISOString(), order_id: null, refusal: null };
  await keep(kept);
  return kept;
}

/** @template T @param {() => Promise<T>} attempt @returns {Promise<T>} */
async function persist(attempt) {
  for (const pause_ms of navigator.onLine ? TRY_AGAIN_AFTER_MS : []) {
    try {
      return await attempt();
    } catch (problem) {
      if (isRefusal(problem)) throw problem;
      await new Promise((resolve) => setTimeout(resolve, pause_ms));
    }
  }
  return attempt();
}
