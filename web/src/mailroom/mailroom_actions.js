/**
 * Actions of a dispatcher on an order or a robot: a table. The words of each stand in the catalogue under its name:
 * `mailroom.do.NAME` for the button, `.title`, `.body` for what follows from it, `.yes`.
 * @import { Alarm, CampusMap, Order, Robot } from "../../types/api_types.ts"
 * @typedef {{value: string, label: string, hint?: string}} Choice
 * @typedef {{reason: string, choice: string}} Answer
 * @typedef {object} Action
 * @property {string} name
 * @property {(answer: Answer) => Promise<unknown>} run
 * @property {Record<string, string>} [names] for the gaps in its words
 * @property {"needed" | "may"} [reason] whether a reason has to be given; absent: none is asked for
 * @property {string} [suggestion] the reason that stands there already
 * @property {Choice[]} [choices]
 * @property {string} [chosen] the choice that is made already
 * @property {boolean} [danger]
 */
import * as api from "../service/api.js";
import { digitsAreLocked, isMailAboard, isRobotComing, robotStands, stateBeforeAttention } from "./mailroom_words.js";
import { hasEnded } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { hasText, t } from "../texts/texts.js";

const LONGER_S = [300, 900, 1800, 3600];
const WAYS_OUT = { aboard: ["resume", "returning", "held"], notAboard: ["resume", "queued", "cancelled"] };
const CARRIED = ["carrying", "at_recipient"];
const ABOARD_BEFORE = ["carrying", "at_recipient", "returning", "at_return"];
const PRIORITIES = ["high", "normal", "low"];

/**
 * The actions on an order that are possible now, the likeliest first.
 * @param {Order} order @param {Robot[]} robots @param {CampusMap | null} map @returns {Action[]}
 */
export function orderActions(order, robots, map) {
  if (hasEnded(order)) return order.custody.some(({ holder, to }) => holder === "robot" && !to) ? [hold(order)] : [];
  const stuck = order.state === "attention";
  const waits = order.state === "queued" || isRobotComing(order);
  return [
    ...(stuck ? [resolve(order)] : []),
    ...(digitsAreLocked(order) ? [release(order)] : []),
    ...(robotStands(order) ? [wait(order)] : []),
    ...(waits ? [priority(order), reassign(order, robots)] : []),
    ...(order.state === "at_return" ? [hold(order)] : []),
    ...(map && isOnItsWay(order) ? [passOn(order, map)] : []),
    ...(order.can_cancel ? [isMailAboard(order) ? bringBack(order) : cancel(order)] : []),
    ...(stuck || order.state === "queued" ? [] : [attention(order)]),
  ];
}

/** @param {Order} order @returns {Pick<Action, "names">} */
const named = (order) => ({ names: { order: t("mailroom.mail_of", { sender: order.sender.name, recipient: order.recipient.name }) } });

/** @param {Order} order @returns {Action} */
export function resolve(order) {
  const isAboard = ABOARD_BEFORE.includes(stateBeforeAttention(order));
  const ways = isAboard ? [...claimedWays(order), ...WAYS_OUT.aboard] : WAYS_OUT.notAboard;
  const choices = ways.map((way) => ({ value: way, label: t(`mailroom.way_out.${way}`), hint: t(`mailroom.way_out_means.${way}`) }));
  return {
    ...named(order),
    ...{ name: "resolve", reason: "may", choices, chosen: "resume" },
    run: ({ choice, reason }) => api.resolveOrder(order.id, choice, reason),
  };
}

/** Of what a robot claims: that mail is out after all, or that it has never come aboard. @param {Order} order */
function claimedWays({ custody }) {
  const holders = custody.filter(({ evidence }) => evidence === "claimed").map(({ holder }) => holder);
  const isSaidToBeOut = holders.some((holder) => holder !== "robot");
  return [...(isSaidToBeOut ? ["handed_over"] : []), ...(holders.includes("robot") ? ["queued"] : [])];
}

/** @param {Order} order @returns {Action} */
export const release = (order) => ({ ...named(order), name: "release", run: () => api.releaseDigits(order.id) });

/** @param {Order} order @returns {Action} */
const wait = (order) => ({
  ...named(order),
  name: "wait",
  choices: LONGER_S.map((longer_s) => ({ value: `${longer_s}`, label: t("mailroom.minutes", { minutes: longer_s / 60 }) })),
  chosen: `${LONGER_S[1]}`,
  run: ({ choice }) => api.letWait(order.id, Number(choice)),
});

/** @param {Order} order @returns {Action} */
const priority = (order) => ({
  ...named(order),
  name: "priority",
  choices: PRIORITIES.map((value) => ({ value, label: t(`mailroom.priority.${value}`) })),
  chosen: order.priority,
  run: ({ choice }) => api.prioritiseOrder(order.id, choice),
});

/** @param {Order} order @param {Robot[]} robots @returns {Action} */
const reassign = (order, robots) => ({
  ...named(order),
  name: "reassign",
  choices: [
    { value: "", label: t("mailroom.any_other") },
    ...robots.filter(({ name }) => name !== order.robot?.name).map(({ name }) => ({ value: name, label: t("robot.name", { name }) })),
  ],
  chosen: "",
  run: ({ choice }) => api.reassignOrder(order.id, choice),
});

/** @param {Order} order @returns {Action} */
const hold = (order) => ({
  ...named(order),
  ...{ name: "hold", reason: "may" },
  run: ({ reason }) => api.holdOrder(order.id, reason),
});

/** Its mail is in a robot that brings it to the recipient, or is stuck with it. @param {Order} order */
const isOnItsWay = (order) => CARRIED.includes(order.state === "attention" ? stateBeforeAttention(order) : order.state);

/** Where the robot was seen last stands first. @param {Order} order @param {CampusMap} map @returns {Action} */
function passOn(order, map) {
  const seen = order.robot?.last_seen?.post ?? "";
  const posts = map.posts.filter(({ name }) => name !== order.to_post);
  const nearest = [...posts.filter(({ name }) => name === seen), ...posts.filter(({ name }) => name !== seen)];
  return {
    ...named(order),
    ...{ name: "pass_on", reason: "may", chosen: nearest[0]?.name },
    choices: nearest.map(({ name }) => ({ value: name, label: titleOf(map, name) })),
    run: ({ choice, reason }) => api.passOrderOn(order.id, choice, reason),
  };
}

/** @param {Order} order @returns {Action} */
const bringBack = (order) => ({ ...named(order), name: "bring_back", danger: true, run: () => api.cancelOrder(order.id) });

/** @param {Order} order @returns {Action} */
const cancel = (order) => ({ ...named(order), name: "cancel", danger: true, run: () => api.cancelOrder(order.id) });

/** @param {Order} order @returns {Action} */
const attention = (order) => ({
  ...named(order),
  ...{ name: "attention", reason: "needed" },
  run: ({ reason }) => api.stopForAttention(order.id, reason),
});

/** One key press on the button, one to say yes: the reason stands there already. @param {Robot} robot @returns {Action} */
export const stop = ({ name }) => ({
  names: { robot: name },
  ...{ name: "stop", reason: "needed", suggestion: t("mailroom.do.stop.suggestion"), danger: true },
  run: ({ reason }) => api.stopRobot(name, reason),
});

/** @param {Robot} robot @returns {Action} */
export const pause = ({ name }) => ({
  names: { robot: name },
  ...{ name: "pause", reason: "needed" },
  run: ({ reason }) => api.pauseRobot(name, reason),
});

/** @param {Robot} robot @returns {Action} */
export const resume = ({ name }) => ({ names: { robot: name }, name: "go_on", run: () => api.resumeRobot(name) });

/** @param {Robot} robot @returns {Action} */
export const recall = ({ name }) => ({
  names: { robot: name },
  ...{ name: "recall", reason: "needed" },
  run: ({ reason }) => api.recallRobot(name, reason),
});

/**
 * For each corridor that the robot of an alarm found closed, if this map has it. What the robot cannot be told now, and
 * why, has words of its own.
 * @param {Alarm} alarm @param {CampusMap} map @returns {Action[]}
 */
export function openWays({ robot, corridor }, map) {
  return map.corridors.filter(({ name }) => name === corridor).map(({ name, a, b }) => {
    const names = { robot, from: titleOf(map, a), to: titleOf(map, b) };
    return { names, name: "open_way", run: () => api.openWay(robot, name).catch(inItsWords("open_way", names)) };
  });
}

/** @param {string} action @param {Record<string, string>} names @returns {(failure: unknown) => never} */
export const inItsWords = (action, names) => (failure) => {
  const key = failure instanceof api.ApiProblem ? `mailroom.do.${action}.${failure.code}` : "";
  throw hasText(key) ? new Error(t(key, names)) : failure;
};
