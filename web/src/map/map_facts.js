/**
 * The facts that a map and its list show: both are made of these facts, so that the drawing says nothing that the list does not. Pure.
 * @import { Alarm, CampusMap, ClosedCorridor, MapCorridor, MapPost, OccupiedCorridor, ReportedPlace, Robot } from "../../types/api_types.ts"
 * @import { Between } from "./map_places.js"
 * @typedef {"stopped" | "charging" | "offline"} Condition
 * @typedef {{post: string, window: {from: string, to: string} | null}} MapArrival where and when, null while no time is known
 * @typedef {object} MapFacts
 * @property {readonly Robot[]} robots by name
 * @property {MapArrival | null} arrival of the order that the map is about: the only time that it tells then
 * @property {Map<string, Robot[]>} seen who is at which post, as it reports, or was seen there last
 * @property {Map<string, Robot[]>} standing the same by bay, those that are in no bay by post
 * @property {readonly Between[]} between who reports to be in a corridor
 * @property {readonly ReportedPlace[]} reported by these robots
 * @property {readonly OccupiedCorridor[]} ahead of `taken` those in which its robot does not report to be
 * @property {Map<string, Robot[]>} expected who is expected at which post
 * @property {readonly OccupiedCorridor[]} taken by these robots, on this map
 * @property {readonly Alarm[]} closed for the robot that turned back in it
 * @property {readonly ClosedCorridor[]} byPeople
 * @property {readonly string[]} shut corridors that a dispatcher has closed, or in which a robot turned back
 * @property {{posts: MapPost[], corridors: MapCorridor[]}} silent where there is no network
 */

import { expectedNext } from "../orders/arrival.js";
import { placesOf } from "./map_places.js";

/** @param {CampusMap} map @param {readonly Robot[]} robots @param {readonly OccupiedCorridor[]} traffic @param {readonly ReportedPlace[]} reported
 *  @param {readonly Alarm[]} alarms @param {readonly ClosedCorridor[]} closed @param {number} now_ms @param {MapArrival | null} [arrival] @returns {MapFacts} */
export function factsOf(map, robots, traffic, reported, alarms, closed, now_ms, arrival = null) {
  const posts = new Set(map.posts.map(({ name }) => name));
  const found = alarms.filter(({ corridor, cleared_at }) => corridor && !cleared_at && corridorNamed(map, corridor));
  const shown = [...robots].sort((a, b) => a.name.localeCompare(b.name, undefined, { numeric: true }));
  /** @param {(robot: Robot) => string | undefined} post */
  const grouped = (post) => by(shown.filter((robot) => posts.has(post(robot) ?? "")), post);
  const { standing, between } = placesOf(map, shown, reported);
  /** @param {"post" | "place"} kind @returns {Map<string, Robot[]>} */
  const standingBy = (kind) => standing.reduce((groups, one) => groups.set(one[kind], [...(groups.get(one[kind]) ?? []), one.robot]), new Map());
  const taken = traffic.filter(({ robot, corridor }) => shown.some(({ name }) => name === robot) && corridorNamed(map, corridor));
  return {
    robots: shown,
    arrival,
    seen: standingBy("post"),
    standing: standingBy("place"),
    between,
    reported: reported.filter(({ robot }) => shown.some(({ name }) => name === robot)),
    expected: arrival ? by(arrival.window ? shown : [], () => arrival.post) : grouped((robot) => expectedNext(robot, now_ms)?.post),
    taken,
    ahead: taken.filter((held) => !between.some(({ robot, corridor }) => robot.name === held.robot && corridor === held.corridor)),
    closed: found,
    byPeople: closed.filter(({ corridor, by_person }) => by_person && corridorNamed(map, corridor)),
    shut: [...found, ...closed].map(({ corridor }) => corridor ?? ""),
    silent: { posts: map.posts.filter(({ network }) => !network), corridors: map.corridors.filter(({ network }) => !network) },
  };
}

/** @param {readonly Robot[]} robots @param {(robot: Robot) => string | undefined} post @returns {Map<string, Robot[]>} */
function by(robots, post) {
  const groups = new Map();
  for (const robot of robots) groups.set(post(robot), [...(groups.get(post(robot)) ?? []), robot]);
  return groups;
}

/** @param {CampusMap} map @param {string} name */
const corridorNamed = (map, name) => map.corridors.find((corridor) => corridor.name === name);

/** The conditions that a robot's shape shows; a robot that has never connected is offline without being missed. @param {Robot} robot @returns {Condition[]} */
export function conditionsOf({ activity, battery, online, heard_at }) {
  /** @type {[Condition, boolean][]} */
  const all = [
    ["stopped", activity === "stopped"],
    ["charging", battery?.charging === true],
    ["offline", !online && heard_at !== null],
  ];
  return all.flatMap(([condition, holds]) => (holds ? [condition] : []));
}

/** Where it may be by now: from the post that saw it to the next, and in every corridor that it holds.
 *  @param {CampusMap} map @param {Robot} robot @param {readonly OccupiedCorridor[]} taken */
function whereaboutsOf(map, { name, last_seen, towards }, taken) {
  const held = taken.filter(({ robot }) => robot === name).map(({ corridor }) => corridor);
  const ahead = map.corridors.find(({ a, b }) => (a === last_seen?.post && b === towards) || (b === last_seen?.post && a === towards));
  const corridors = map.corridors.filter((corridor) => corridor === ahead || held.includes(corridor.name));
  return [...map.posts.filter((post) => post.name === last_seen?.post), ...corridors];
}

/** True if an offline robot may be where there is no network. @param {CampusMap} map @param {Robot} robot @param {readonly OccupiedCorridor[]} taken */
export const isSilentAsExpected = (map, robot, taken) =>
  conditionsOf(robot).includes("offline") && whereaboutsOf(map, robot, taken).some(({ network }) => !network);

/** Where a robot must be by now: somewhere between the post that saw it and this one. @param {Robot} robot */
export const nextPost = ({ expected, towards }) => expected?.post ?? towards;
