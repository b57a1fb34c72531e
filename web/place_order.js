/**
 * Sending an order so that a double tap, a lost answer or a reload is still one order: its key is kept, for as long as
 * this tab lives, until the service has answered.
 * @import { Order, WantedOrder } from "./api_types.ts"
 */
import * as api from "./api.js";

const KEPT = "order-without-answer";
const TRY_AGAIN_AFTER_MS = [700, 2_500];

/** @returns {{key: string, wanted: WantedOrder} | null} */
const kept = () => JSON.parse(sessionStorage.getItem(KEPT) ?? "null");

/** The order that was sent and never answered, if there is one. */
export const unansweredOrder = () => kept()?.wanted ?? null;

/** @param {WantedOrder} wanted @returns {Promise<Order>} */
export async function placeOrder(wanted) {
  const key = keyFor(wanted);
  sessionStorage.setItem(KEPT, JSON.stringify({ key, wanted }));
  try {
    const order = await persist(() => api.placeOrder(wanted, key));
    sessionStorage.removeItem(KEPT);
    return order;
  } catch (problem) {
    if (isFinal(problem)) sessionStorage.removeItem(KEPT);
    throw problem;
  }
}

/** @param {WantedOrder} wanted */
function keyFor(wanted) {
  const before = kept();
  return before && JSON.stringify(before.wanted) === JSON.stringify(wanted) ? before.key : crypto.randomUUID();
}

/** The service has refused; anything else may still have become an order. @param {unknown} problem */
const isFinal = (problem) => problem instanceof api.ApiProblem && problem.status < 500 && problem.status !== 409;

/** @template T @param {() => Promise<T>} attempt @returns {Promise<T>} */
async function persist(attempt) {
  for (const pause_ms of TRY_AGAIN_AFTER_MS) {
    try {
      return await attempt();
    } catch (problem) {
      if (isFinal(problem)) throw problem;
      await new Promise((resolve) => setTimeout(resolve, pause_ms));
    }
  }
  return attempt();
}
