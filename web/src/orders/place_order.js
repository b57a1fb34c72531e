/**
 * Sending an order so that a double tap, a lost answer, a reload or no network at all is still one order: it lies in the
 * outbox, with its key, until the service has answered.
 * @import { Order, WantedOrder } from "../../types/api_types.ts"
 * @import { KeptOrder } from "../offline/outbox.js"
 */
import * as api from "../service/api.js";
import {
  announce, anyKept, discard, inSession, isForLater, isPassing, keep, keptOrders, refuse, sendLater,
} from "../offline/outbox.js";
import { sayKept } from "../session/session.js";

const TRY_AGAIN_AFTER_MS = [700, 2_500];

/** The order lies in the outbox, where its person sees it: it waits for a network, or was refused as it is. */
export class Kept extends Error {}

/** @param {WantedOrder} wanted @param {string} person_id @returns {Promise<Order>} throws Kept, ApiProblem */
export async function placeOrder(wanted, person_id) {
  const kept = await keptAs(wanted, person_id);
  // Said before it is sent: a page that is closed meanwhile leaves an order that the next one has to show.
  sayKept(true);
  try {
    return await inSession(() => sent(kept));
  } finally {
    sayKept(await anyKept());
    announce();
  }
}

/** @param {KeptOrder} kept @returns {Promise<Order>} */
async function sent(kept) {
  try {
    const order = await persist(() => api.placeOrder(kept.wanted, kept.key));
    await discard(kept.key);
    return order;
  } catch (problem) {
    if (isPassing(problem)) await sendLater();
    else if (problem instanceof api.ApiProblem && isForLater(problem)) await refuse(kept, problem);
    else {
      if (problem instanceof api.ApiProblem) await discard(kept.key);
      throw problem;
    }
    throw new Kept();
  }
}

/** The same order that lies here already is that order. @param {WantedOrder} wanted @param {string} person_id @returns {Promise<KeptOrder>} */
async function keptAs(wanted, person_id) {
  const unsent = (await keptOrders(person_id)).filter(({ order_id }) => !order_id);
  const before = unsent.find((kept) => JSON.stringify(kept.wanted) === JSON.stringify(wanted));
  const kept = before
    ? { ...before, refusal: null }
    : { key: crypto.randomUUID(), person_id, wanted, at: new Date().toISOString(), order_id: null, refusal: null };
  await keep(kept);
  return kept;
}

/** @template T @param {() => Promise<T>} attempt @returns {Promise<T>} */
async function persist(attempt) {
  for (const pause_ms of navigator.onLine ? TRY_AGAIN_AFTER_MS : []) {
    try {
      return await attempt();
    } catch (problem) {
      if (!isPassing(problem)) throw problem;
      await new Promise((resolve) => setTimeout(resolve, pause_ms));
    }
  }
  return attempt();
}
