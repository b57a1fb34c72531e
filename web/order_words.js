/**
 * An order in words: where it stands, what comes next, what has happened.
 * @import { CampusMap, Order, OrderEvent, OrderState, Words } from "./api_types.ts"
 * @typedef {{state: OrderState, text: string, event: OrderEvent | null}} Entry an event, or a step still to come (null)
 */
import { titleOf } from "./posts.js";
import { hasText, t } from "./texts.js";

/**
 * Why something waits, in this page's language; a sentence that the catalogue does not have is shown as it was said.
 * @param {string} said @param {Words | null} words @param {CampusMap} map
 */
export function reasonText(said, words, map) {
  if (!words || !hasText(words.key)) return t("why.in_english", { sentence: said });
  const { post } = words.facts;
  return t(words.key, post ? { ...words.facts, post: titleOf(map, post) } : words.facts);
}

/** The usual way of an order, in order. */
const WAY = /** @type {OrderState[]} */ ([
  "queued", "assigned", "to_sender", "at_sender", "carrying", "at_recipient", "delivered",
]);

/** What each part of the way is called, and the states in it. */
const STAGES = /** @type {Record<string, OrderState[]>} */ ({
  collect: ["queued", "assigned", "to_sender"],
  load: ["at_sender"],
  carry: ["carrying"],
  receive: ["at_recipient"],
});

const ENDED = /** @type {OrderState[]} */ (["delivered", "returned", "held", "expired", "cancelled"]);

/** @param {Order} order */
export const hasEnded = (order) => ENDED.includes(order.state);

/** Whether the robot carries the mail to its recipient. @param {Order} order */
export const isAboard = (order) => order.state === "carrying" || order.state === "at_recipient";

/** Where the robot waits for each code. */
const AT_ME = { load: "at_sender", receive: "at_recipient", return: "at_return" };

/** Whether a robot stands somewhere and waits for a hand-over. @param {Order} order */
export const isAtAStop = (order) => Object.values(AT_ME).includes(order.state);

/** Whether the robot is there and waits for me. @param {Order} order */
export const isMyTurn = (order) => order.my_code !== null && AT_ME[order.my_code] === order.state;

/** The names that the sentences about an order use. @param {Order} order @param {CampusMap} map */
const names = (order, map) => ({
  robot: order.robot ? t("robot.name", { name: order.robot.name }) : t("robot.some"),
  from: titleOf(map, order.from_post),
  to: titleOf(map, order.to_post),
  sender: order.sender.name,
  recipient: order.recipient.name,
});

/** @param {"state" | "next"} what @param {Order} order @param {CampusMap} map */
function sentence(what, order, map) {
  const mine = `${what}.${order.my_role}.${order.state}`;
  return t(hasText(mine) ? mine : `${what}.sender.${order.state}`, names(order, map));
}

/** Where it stands, for the person who looks. @param {Order} order @param {CampusMap} map */
export const stateSentence = (order, map) => sentence("state", order, map);

/** What happens next, or what that person is to do. @param {Order} order @param {CampusMap} map */
export function nextSentence(order, map) {
  if (order.cancel_requested || order.return_requested) return t(isAboard(order) ? "bring_back.requested" : "cancel.requested");
  return sentence("next", order, map);
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

/** What is told besides the states. */
const TOLD_TOO = ["wait_extended", "delegate_named", "delegate_revoked", "return_requested", "delayed", "taken_out"];

/** @param {OrderEvent} event @param {Record<string, string>} values */
const happening = ({ kind, state }, values) => t(kind === "moved" ? `timeline.${state}` : `timeline.event.${kind}`, values);

/** Everything that happened, then what is still to come on the usual way. @param {Order} order @param {CampusMap} map @returns {Entry[]} */
export function timeline(order, map) {
  const values = names(order, map);
  const happened = order.events.filter(({ kind }) => kind === "moved" || TOLD_TOO.includes(kind)).map((event) => ({
    state: event.state,
    text: happening(event, event.robot ? { ...values, robot: t("robot.name", { name: event.robot }) } : values),
    event,
  }));
  const reached = WAY.indexOf(order.state);
  const ahead = reached < 0 ? [] : WAY.slice(reached + 1);
  return [...happened, ...ahead.map((state) => ({ state, text: t(`timeline.to_come.${state}`, values), event: null }))];
}
