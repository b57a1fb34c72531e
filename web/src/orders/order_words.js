/**
 * An order in words: where it stands, what comes next, what has happened.
 * @import { CampusMap, Order, OrderEvent, OrderState, Robot, WaitsFor } from "../../types/api_types.ts"
 * @typedef {{state: OrderState, text: string, event: OrderEvent | null}} Entry an event, or a step still to come (null)
 */
import { titleOf } from "../service/posts.js";
import { reasonText } from "../texts/reason_words.js";
import { serverNow } from "../service/server_clock.js";
import { hasText, t } from "../texts/texts.js";
import { clockTime, percent } from "../texts/times.js";

/** Why a robot does what it does; of what it waits for, the service knows more than it says itself. @param {Robot} robot @param {CampusMap} map */
export function robotWhy(robot, map) {
  if (robot.waits_for && !robot.taken_out_at) return waitText(robot.waits_for, map) ?? reasonText(robot.why ?? "", robot.why_words, map);
  if (robot.why_words?.key === "why.paused" && robot.last_seen) return t("why.paused_at", { post: titleOf(map, robot.last_seen.post) });
  return reasonText(robot.why ?? "", robot.why_words, map);
}

/** Why an order stands where it stands; what a person of the mailroom has typed, as it was typed. @param {Order} order @param {CampusMap} map */
export function orderReason({ why, why_words, events }, map) {
  const moved = events.findLast(({ kind }) => kind === "moved");
  return moved?.state === "attention" ? eventReason({ ...moved, reason: why, reason_words: why_words }, map) : reasonText(why ?? "", why_words, map);
}

/** The same; of what its robot waits for, the service knows more than the sentence says. @param {Order} order @param {CampusMap} map */
export const orderWhy = (order, map) =>
  order.robot && order.robot.why === order.why ? robotWhy(order.robot, map) : orderReason(order, map);

/** Reasons that may be of another order's stop. */
const OF_A_STOP = ["why.sender", "why.recipient", "why.to_return"];

/** The order when its robot has news. The service's word about an order follows some seconds later; where that word was the
 * robot's own, the robot's new one takes its place. @param {Order} order @param {Robot | null} before @param {Robot} robot @returns {Order} */
export function asItsRobotSays(order, before, robot) {
  const isElsewhere = !isAtAStop(order) && OF_A_STOP.includes(robot.why_words?.key ?? "");
  return before && order.why === before.why && !isElsewhere ? { ...order, why: robot.why, why_words: robot.why_words } : order;
}

/** The reason of something that happened. @param {Pick<OrderEvent, "by" | "reason" | "reason_words">} event @param {CampusMap} map */
export function eventReason({ by, reason, reason_words }, map) {
  if (!reason) return "";
  return by !== "robot" && by !== "timer" && !reason_words ? reason : reasonText(reason, reason_words, map);
}

/**
 * The charge, and until about when it charges. @param {NonNullable<Robot["battery"]>} battery
 */
export function batteryText({ ratio, charging, charges_to }) {
  const charge = percent(ratio);
  if (!charging || !charges_to || Date.parse(charges_to.at) <= serverNow()) return t(charging ? "robot.charging" : "robot.battery", { charge });
  return t("robot.charging_until", { charge, enough: percent(charges_to.ratio), time: clockTime(charges_to.at) });
}

/** "Waits for the corridor UC – Canal, taken by r2 until about 12:41" @param {WaitsFor} waits @param {CampusMap} map */
function waitText({ from_post, to_post, robots, until, closed }, map) {
  const names = { from: titleOf(map, from_post), to: titleOf(map, to_post), robots: robots.join(", "), time: until ? clockTime(until) : "" };
  if (closed) return t("robot.waits.closed", names);
  if (!robots.length) return null;
  return t(until && Date.parse(until) > serverNow() ? "robot.waits.until" : "robot.waits.taken", names);
}

/** The usual way of an order, in order. */
const WAY = /** @type {OrderState[]} */ ([
  "queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered",
]);

const LOADED = WAY.indexOf("carrying");

/** The stages of an order, and the states in each. */
const STAGES = /** @type {Record<string, OrderState[]>} */ ({
  collect: ["queued", "assigned", "to_sender"],
  load: ["at_sender"],
  carry: ["carrying"],
  receive: ["at_recipient"],
});

const ENDED = /** @type {OrderState[]} */ (["delivered", "returned", "held", "expired", "cancelled"]);

/** @param {Order} order */
export const hasEnded = (order) => ENDED.includes(order.state);

/** True while the robot carries the mail to its recipient. @param {Order} order */
export const isAboard = (order) => order.state === "carrying" || order.state === "at_recipient";

/** Where the robot waits for each code. */
const AT_ME = { load: "at_sender", receive: "at_recipient", return: "at_return" };

/** True while a robot stands at a post and waits for a hand-over. @param {Order} order */
export const isAtAStop = (order) => Object.values(AT_ME).includes(order.state);

/** True while the robot waits at a post for this person. @param {Order} order */
export const isMyTurn = (order) => order.my_code !== null && AT_ME[order.my_code] === order.state;

/** The names that the sentences about an order use. @param {Order} order @param {CampusMap} map */
const names = (order, map) => ({
  robot: order.robot ? t("robot.name", { name: order.robot.name }) : t("robot.some"),
  from: titleOf(map, order.from_post),
  at: titleOf(map, order.passed_on_at_post ?? order.from_post),
  to: titleOf(map, order.to_post),
  sender: order.sender.name,
  recipient: order.recipient.name,
});

/** The mailroom has it until the next robot loads it. @param {Order} order */
export const isBetweenLegs = ({ state, passed_on_at_post }) => 
  passed_on_at_post !== null && WAY.slice(0, LOADED).includes(state);

/** True for an order whose time has not come: no robot is searched yet. @param {Order} order @param {number} now_ms */
function stateOf(order, now_ms) {
  const { state, not_before } = order;
  if (isBetweenLegs(order)) return "passed_on";
  return state === "queued" && not_before && Date.parse(not_before) > now_ms ? "later" : state;
}

/** @param {"state" | "next"} what @param {Order} order @param {CampusMap} map @param {number} now_ms */
function sentence(what, order, map, now_ms) {
  const state = stateOf(order, now_ms);
  const mine = `${what}.${order.my_role}.${state}`;
  return t(hasText(mine) ? mine : `${what}.sender.${state}`, names(order, map));
}

/** Where it stands, for the person who looks. @param {Order} order @param {CampusMap} map @param {number} now_ms */
export const stateSentence = (order, map, now_ms) => sentence("state", order, map, now_ms);

/** The next event, or the next thing this person has to do. @param {Order} order @param {CampusMap} map @param {number} now_ms */
export function nextSentence(order, map, now_ms) {
  if (order.cancel_requested || order.return_requested) return t(isAboard(order) ? "bring_back.requested" : "cancel.requested");
  return sentence("next", order, map, now_ms);
}

/** @param {Order} order @returns {{name: string, done: boolean, now: boolean}[]} nothing where the order left the usual way */
export function stages(order) {
  if (!WAY.includes(order.state)) return [];
  return Object.entries(STAGES).map(([name, states]) => ({
    name,
    done: states.every((state) => WAY.indexOf(state) < WAY.indexOf(order.state)),
    now: states.includes(order.state),
  }));
}

/** Events that are shown besides the states. */
const OTHER_EVENTS = ["wait_extended", "delegate_named", "delegate_revoked", "return_requested", "delayed", "taken_out"];

/** @param {OrderEvent} event @param {Record<string, string>} values */
function eventText(event, values) {
  if (isPassingOn(event)) return t("timeline.passed_on", values);
  return t(event.kind === "moved" ? `timeline.${event.state}` : `timeline.event.${event.kind}`, values);
}

/** True for an order back in the queue, after a dispatcher has said where the mail is. @param {OrderEvent} event */
const isPassingOn = ({ seq, kind, state, post, by }) =>
  seq > 1 && kind === "moved" && state === "queued" && by === "dispatcher" && post !== null;

/** The values of each event's words: after it was passed on it is fetched there. @param {Order} order @param {CampusMap} map */
function* valuesOfEvents(order, map) {
  let values = names(order, map);
  for (const event of order.events) {
    if (isPassingOn(event) && event.post) values = { ...values, from: titleOf(map, event.post), at: titleOf(map, event.post) };
    yield { event, values: event.robot ? { ...values, robot: t("robot.name", { name: event.robot }) } : values };
  }
}

/** Everything that happened, then what is still to come on the usual way. @param {Order} order @param {CampusMap} map @returns {Entry[]} */
export function timeline(order, map) {
  const said = [...valuesOfEvents(order, map)].filter(({ event: { kind } }) => kind === "moved" || OTHER_EVENTS.includes(kind));
  const happened = said.map(({ event, values }) => ({ state: event.state, text: eventText(event, values), event }));
  const values = { ...names(order, map), ...(isBetweenLegs(order) && { from: names(order, map).at }) };
  const reached = WAY.indexOf(order.state);
  const ahead = reached < 0 ? [] : WAY.slice(reached + 1);
  return [...happened, ...ahead.map((state) => ({ state, text: t(`timeline.to_come.${state}`, values), event: null }))];
}
