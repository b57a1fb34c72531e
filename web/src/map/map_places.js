/**
 * Where each robot is drawn: in the bay, on the crossing or in the corridor that it reports to be in; without a report, at
 * the post that saw it last. Pure.
 * @import { CampusMap, ReportedPlace, Robot } from "../../types/api_types.ts"
 * @import { Drawing, Point } from "./map_drawing.js"
 * @typedef {{robot: Robot, post: string, place: string}} Standing at a post: `place` is the post itself or one of its bays
 * @typedef {{robot: Robot, corridor: string, from_post: string, to_post: string}} Between
 */
import { baysOf, placeNamed } from "./map_bays.js";
import { along, pointsFrom } from "./map_drawing.js";

/** The corridor that it is in. @param {CampusMap} map @param {ReportedPlace} reported */
export const corridorOf = (map, { place, towards }) =>
  map.corridors.find(({ a, b }) => (a === place && b === towards) || (b === place && a === towards));

/** The post that it is at, and the bay; on a spur it is counted to the bay at the end. @param {CampusMap} map
 *  @param {ReportedPlace} reported */
export const postOf = (map, { kind, place, towards }) => {
  const [here, there] = [placeNamed(map, place), placeNamed(map, towards ?? "")];
  return kind === "corridor" ? [here, there].find((one) => one?.number) : here;
};

/** @param {CampusMap} map @param {readonly Robot[]} robots @param {readonly ReportedPlace[]} reported
 *  @returns {{standing: Standing[], between: Between[]}} */
export function placesOf(map, robots, reported) {
  /** @type {Standing[]} */
  const standing = [];
  /** @type {Between[]} */
  const driving = [];
  for (const robot of robots) {
    const told = reported.find((one) => one.robot === robot.name);
    const corridor = told && corridorOf(map, told)?.name;
    const at = (told && postOf(map, told)) ?? placeNamed(map, robot.last_seen?.post ?? "");
    if (corridor) driving.push({ robot, corridor, from_post: told.place, to_post: told.towards ?? "" });
    else if (at) standing.push({ robot, post: at.post.name, place: at.number ? baysOf(at.post)[at.number - 1].name : at.post.name });
  }
  return { standing, between: driving };
}

/** Each in its corridor: in the middle, several one behind the other. @param {Drawing} drawn @param {readonly Between[]} all
 *  @returns {(Between & Point & {degrees: number})[]} */
export const inCorridors = (drawn, all) =>
  all.map((one) => {
    const alike = all.filter(({ corridor }) => corridor === one.corridor);
    const part = (alike.indexOf(one) + 1) / (alike.length + 1);
    const way = pointsFrom(drawn, one.from_post, one.to_post);
    return { ...one, ...along(way, one.from_post < one.to_post ? part : 1 - part) };
  });
