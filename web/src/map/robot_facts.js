/** The robots on a map as a list: everything that the map shows of them, and why they do it. */
import { html, nothing } from "lit";
import { expectedNext } from "../orders/arrival.js";
import { conditionsOf, isSilentAsExpected } from "./map_facts.js";
import { corridorOf, postOf } from "./map_places.js";
import { batteryText, robotWhy } from "../orders/order_words.js";
import { corridorTitle, titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago, clockTime, windowText } from "../texts/times.js";
import { icon } from "../elements/icon.js";
/** @import { Alarm, CampusMap, ReportedPlace, Robot } from "../../types/api_types.ts" */
/** @import { MapFacts } from "./map_facts.js" */

/** @param {CampusMap} map @param {MapFacts} facts @param {string} from @param {string} to */
export function robotFacts(map, facts, from, to) {
  const { robots } = facts;
  const ends = from && to ? [fact("arrow", t("map.from_fact", { post: titleOf(map, from) })), fact("pin", t("map.to_fact", { post: titleOf(map, to) }))] : [];
  const closed = facts.byPeople.map(({ corridor, reason }) =>
    fact("warning", t("map.closed_by_people", { corridor: corridorTitle(map, corridor), reason })));
  if (robots.length > 1) return html`<ul class="facts several">${robots.map((robot) => ofSeveral(map, facts, robot))}${closed}${ends}</ul>`;
  const none = fact("robot", t(ends.length ? "map.no_robot" : "map.no_robots"));
  return html`<ul class="facts">${robots.length ? aboutRobot(map, facts, robots[0]) : none}${closed}${ends}</ul>`;
}

/** @param {CampusMap} map @param {MapFacts} facts @param {Robot} robot */
const ofSeveral = (map, facts, robot) => html`<li>
  <strong>${t("robot.name", { name: robot.name })}</strong>
  <ul class="facts">${aboutRobot(map, facts, robot)}</ul>
</li>`;

/** @param {CampusMap} map @param {MapFacts} facts @param {Robot} robot */
const aboutRobot = (map, facts, robot) => [
  robot.last_seen || !reportsOf(facts, robot).length ? fact("robot", seenText(map, robot)) : nothing,
  reportsOf(facts, robot).map((told) => fact("pin", reportedText(map, told))),
  aheadFact(map, robot, facts.arrival),
  conditionsOf(robot).includes("stopped") ? fact("warning", t("map.stopped")) : nothing,
  robot.why && (!facts.arrival || robot.activity === "driving") ? fact("send", robotWhy(robot, map)) : nothing,
  facts.ahead.filter((taken) => taken.robot === robot.name).map((taken) => fact("corridor", occupiedText(map, taken))),
  facts.closed.filter((alarm) => alarm.robot === robot.name).map((alarm) => fact("warning", closedText(map, alarm))),
  conditionsOf(robot).includes("offline") ? fact("network", silentText(map, facts, robot)) : nothing,
  batteryFact(robot),
];

/** @param {CampusMap} map @param {Robot} robot */
const seenText = (map, { last_seen }) =>
  last_seen ? t("map.seen", { post: titleOf(map, last_seen.post), ago: ago(last_seen.at, serverNow()) }) : t("map.never_seen");

/** @param {MapFacts} facts @param {Robot} robot */
const reportsOf = ({ reported }, { name }) => reported.filter(({ robot }) => robot === name);

/** @param {CampusMap} map @param {ReportedPlace} told */
function reportedText(map, told) {
  const time = clockTime(told.at);
  if (corridorOf(map, told)) return t("map.in.corridor", { from: titleOf(map, told.place), to: titleOf(map, told.towards), time });
  const at = postOf(map, told);
  const values = { number: at?.number ?? 0, post: at?.post.title ?? told.place, time };
  return t(at?.number ? "map.in.bay" : "map.in.crossing", values);
}

/** On the map of one order its arrival is the only time. @param {CampusMap} map @param {Robot} robot @param {MapFacts["arrival"]} arrival */
function aheadFact(map, robot, arrival) {
  const { towards, activity } = robot;
  const expected = arrival ? arrival.window && { post: arrival.post, ...arrival.window } : expectedNext(robot, serverNow());
  if (expected) return fact("clock", t("map.expected", { post: titleOf(map, expected.post), window: windowText(expected, serverNow()) }));
  return towards && activity === "driving" ? fact("clock", t("map.towards", { post: titleOf(map, towards) })) : nothing;
}

/** @param {CampusMap} map @param {{from_post: string, to_post: string, since: string}} taken */
const occupiedText = (map, { from_post, to_post, since }) =>
  t("map.taken", { from: titleOf(map, from_post), to: titleOf(map, to_post), time: clockTime(since) });

/** @param {CampusMap} map @param {Alarm} alarm */
function closedText(map, { corridor, at }) {
  const { a, b } = map.corridors.find(({ name }) => name === corridor) ?? { a: "", b: "" };
  return t("map.closed", { from: titleOf(map, a), to: titleOf(map, b), time: clockTime(at) });
}

/** @param {CampusMap} map @param {MapFacts} facts @param {Robot} robot */
function silentText(map, { taken }, robot) {
  const values = { ago: ago(robot.heard_at ?? "", serverNow()) };
  if (isSilentAsExpected(map, robot, taken)) return t("map.silent_as_expected", values);
  return t(robot.activity === "stopped" ? "map.offline" : "robot.offline", values);
}

/** @param {Robot} robot */
const batteryFact = ({ battery }) =>
  battery ? fact("battery", batteryText(battery)) : nothing;

/** @param {Parameters<typeof icon>[0]} drawing @param {string} text */
const fact = (drawing, text) => html`<li>${icon(drawing)}<span>${text}</span></li>`;
