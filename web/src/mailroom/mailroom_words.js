/**
 * The mailroom in words, pure: what is wrong, why an order waits, in which order the queue stands.
 * @import { Alarm, CampusMap, Order, OrderState, Robot, Sending } from "../../types/api_types.ts"
 * @typedef {{orders: Order[], robots: Robot[], alarms: Alarm[], givenUp: Sending[]}} Known
 * @typedef {{kind: "alarm", key: string, alarm: Alarm} | {kind: "attention", key: string, order: Order}
 *   | {kind: "locked", key: string, order: Order} | {kind: "stopped", key: string, robot: Robot}
 *   | {kind: "silent", key: string, robot: Robot} | {kind: "given_up", key: string, sending: Sending}} Issue
 */
import { arrivalOf } from "../orders/arrival.js";
import { hasEnded, isBetweenLegs, orderWhy } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { clockTime, dayAndTime } from "../texts/times.js";

const COMING = /** @type {OrderState[]} */ (["assigned", "to_sender", "at_sender"]);
const ABOARD = /** @type {OrderState[]} */ (["carrying", "at_recipient", "returning", "at_return"]);
const STANDS = /** @type {OrderState[]} */ (["at_sender", "at_recipient", "at_return"]);

/** @param {Order} order */
export const isRobotComing = (order) => COMING.includes(order.state);
/** @param {Order} order */
export const isMailAboard = (order) => ABOARD.includes(order.state);
/** True while the robot waits at a post for a sender or recipient. @param {Order} order */
export const robotStands = (order) => STANDS.includes(order.state);

/** The state in which a fault struck. @param {Order} order */
export function stateBeforeAttention(order) {
  const moves = order.events.filter(({ kind, state }) => kind === "moved" && state !== "attention");
  return moves.at(-1)?.state ?? "queued";
}

/** True after five wrong entries, until a dispatcher unlocks the digits. @param {Order} order */
export const digitsAreLocked = (order) =>
  order.events.findLast(({ kind }) => kind === "digits_locked" || kind === "digits_released")?.kind === "digits_locked";

/** True for a robot that continues only on a person's command. @param {Robot} robot */
export const isHeldUp = (robot) => robot.activity === "stopped" || robot.why_words?.key === "why.paused";

/** Longer than the patches without network are, and not so long that it must have been put away. */
const SILENT_MS = { from: 5 * 60_000, to: 7 * 24 * 3_600_000 };

/** @param {Robot} robot */
export function isSilent({ online, heard_at }) {
  const age_ms = heard_at ? serverNow() - Date.parse(heard_at) : 0;
  return !online && age_ms > SILENT_MS.from && age_ms < SILENT_MS.to;
}

/** All issues that need a dispatcher, the most urgent first. @param {Known} known @returns {Issue[]} */
export function openIssues({ orders, robots, alarms, givenUp }) {
  const open = orders.filter((order) => !hasEnded(order));
  const locked = open.filter(digitsAreLocked);
  // Locked digits and robots that have vanished ring an alarm too: one line is enough.
  const ringing = alarms.filter((one) => !one.acknowledged_at && !one.cleared_at && !(locked.length && one.name === "digits_locked"));
  return [
    ...ringing
      .map((alarm) => /** @type {Issue} */ ({ kind: "alarm", key: `alarm-${alarm.id}`, alarm })),
    ...open.filter(({ state }) => state === "attention")
      .map((order) => /** @type {Issue} */ ({ kind: "attention", key: `attention-${order.id}`, order })),
    ...locked.map((order) => /** @type {Issue} */ ({ kind: "locked", key: `locked-${order.id}`, order })),
    ...robots.filter(isHeldUp).map((robot) => /** @type {Issue} */ ({ kind: "stopped", key: `stopped-${robot.name}`, robot })),
    ...robots.filter((robot) => isSilent(robot) && !ringing.some((one) => one.name === "vanished" && one.robot === robot.name))
      .map((robot) => /** @type {Issue} */ ({ kind: "silent", key: `silent-${robot.name}`, robot })),
    ...givenUp.map((sending) => /** @type {Issue} */ ({ kind: "given_up", key: `sending-${sending.id}`, sending })),
  ];
}

/** The name of an order in a list. @param {Order} order */
export const orderTitle = (order) =>
  t("mailroom.order", { sender: order.sender.name, recipient: order.recipient.name });

/** "Post 1 → Post 4" @param {Order} order @param {CampusMap} map */
export const orderWay = (order, map) => `${titleOf(map, order.from_post)} → ${titleOf(map, order.to_post)}`;

/** Why it stands where it stands; empty where it simply goes on. @param {Order} order @param {CampusMap} map @returns {string} */
export function whyItWaits(order, map) {
  const now_ms = serverNow();
  const { not_before, wait_until } = order;
  if (isReturnAsked(order)) return t("mailroom.why.asked_back");
  if (order.state === "queued" && not_before && Date.parse(not_before) > now_ms) {
    return t("mailroom.why.not_before", { time: dayAndTime(not_before, now_ms) });
  }
  if (isBetweenLegs(order)) {
    const held = t("mailroom.why.passed_on", { at: titleOf(map, order.passed_on_at_post ?? "") });
    return order.why ? t("mailroom.why.passed_on_waits", { held, why: orderWhy(order, map) }) : held;
  }
  const why = order.why ? orderWhy(order, map) : t(`mailroom.why.${order.state}`);
  return wait_until && robotStands(order) ? t("mailroom.why.until", { why, time: clockTime(wait_until) }) : why;
}

/** For a wall display: a typed reason may name people. @param {Order} order */
export const withoutOwnWords = (order) => (order.why_words ? order : { ...order, why: null });

/** True for a recalled order whose robot has not answered yet. @param {Order} order */
const isReturnAsked = (order) => order.return_requested || (order.cancel_requested && isRobotComing(order));

/** Since when the order is in the state that it is in. @param {Order} order */
export const since = (order) => order.events.findLast(({ kind }) => kind === "moved")?.at ?? order.created_at;

const PRIORITIES = ["high", "normal", "low"];
const STATES = ["attention", "at_sender", "at_recipient", "at_return", "queued", "assigned", "to_sender", "carrying", "returning"];

/** @type {Record<string, (order: Order, map: CampusMap) => string | number>} */
const SORTINGS = {
  waiting: (order) => Date.parse(since(order)),
  priority: (order) => PRIORITIES.indexOf(order.priority),
  state: (order) => STATES.indexOf(order.state),
  way: (order, map) => orderWay(order, map),
  window: (order) => Date.parse(arrivalOf(order, serverNow())?.window?.to ?? "") || Infinity,
  robot: (order) => order.robot?.name ?? "\uffff",
};

export const SORTING_NAMES = Object.keys(SORTINGS);

/** Sort orders; equal ones by how long they wait. @param {Order[]} orders @param {string} sorting @param {CampusMap} map */
export function sorted(orders, sorting, map) {
  const value = SORTINGS[sorting] ?? SORTINGS.waiting;
  return [...orders].sort((a, b) => compare(value(a, map), value(b, map)) || compare(since(a), since(b)) || compare(a.id, b.id));
}

/** @param {string | number} a @param {string | number} b */
const compare = (a, b) => (a < b ? -1 : a > b ? 1 : 0);

/** For a wall that everybody sees: "Ada Lovelace" → "A. Lovelace", and what is no name stays hidden. @param {string} name */
export function shortName(name) {
  const words = name.replace(/@.*/, "").split(/[\s.]+/).filter(Boolean);
  return words.length < 2 ? words.map((word) => `${word[0]}.`).join("") : `${words[0][0]}. ${words.slice(1).join(" ")}`;
}
