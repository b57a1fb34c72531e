/**
 * The one reading of an order's estimate: hero, map, cards, queue and the page of a link all say what is said here. Pure.
 * @import { CampusMap, Expected, Order, Robot } from "../../types/api_types.ts"
 * @typedef {{window: {from: string, to: string} | null, assumed: boolean, late: boolean}} Arrival `window`: null while no time is known
 */
import { orderReason } from "./order_words.js";
import { t } from "../texts/texts.js";
import { windowText } from "../texts/times.js";

/** Null where no arrival is ahead. An interval that is over is none, however old the answer is. @param {Order} order @param {number} now_ms @returns {Arrival | null} */
export function arrivalOf({ estimate }, now_ms) {
  if (!estimate) return null;
  const { from, to, assumed, late, promised_to } = estimate;
  const window = from && to && Date.parse(to) > now_ms ? { from, to } : null;
  return { window, assumed, late: late || (promised_to !== null && Date.parse(promised_to) < now_ms) };
}

/** "2:11 – 2:15 p.m.", or that it is not known; empty where no arrival is ahead. @param {Order} order @param {number} now_ms */
export function arrivalText(order, now_ms) {
  const arrival = arrivalOf(order, now_ms);
  if (!arrival) return "";
  return arrival.window ? windowText(arrival.window, now_ms) : t("arrival.unknown");
}

/** @param {Order} order @param {number} now_ms */
export const isLate = (order, now_ms) => arrivalOf(order, now_ms)?.late === true;

/** Why no time is known; one whose time has run out takes longer. @param {Order} order @param {CampusMap} map */
export function whyUnknown(order, map) {
  const { reason, reason_words } = order.estimate ?? {};
  return reason ? orderReason({ ...order, why: reason, why_words: reason_words ?? null }, map) : t("why.takes_longer");
}

/** Where a robot is expected next, as long as that is not over. @param {Robot} robot @param {number} now_ms @returns {Expected | null} */
export const expectedNext = ({ expected }, now_ms) => (expected && Date.parse(expected.to) > now_ms ? expected : null);

/** Robots whose next post is where they bring an order are expected there when that order is. @param {readonly Robot[]} robots @param {readonly Order[]} orders @param {number} now_ms @returns {Robot[]} */
export const expectedWithOrders = (robots, orders, now_ms) =>
  robots.map((robot) => {
    const brought = orders.find((order) => order.robot?.name === robot.name && order.state === "carrying" && order.to_post === robot.expected?.post);
    const arrival = brought && arrivalOf(brought, now_ms);
    return arrival ? { ...robot, expected: arrival.window && { post: brought.to_post, ...arrival.window } } : robot;
  });
