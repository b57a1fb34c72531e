/**
 * Traffic actions of a dispatcher: the same kind of table as `mailroom_actions.js`.
 * @import { CampusMap, ClosedCorridor, Robot } from "../../types/api_types.ts"
 * @import { Action } from "./mailroom_actions.js"
 */
import * as api from "../service/api.js";
import { inItsWords } from "./mailroom_actions.js";
import { corridorTitle } from "../service/posts.js";
import { t } from "../texts/texts.js";

/** One of those that are open. @param {CampusMap} map @param {readonly ClosedCorridor[]} closed @returns {Action} */
export function closeOne(map, closed) {
  const open = map.corridors.filter(({ name }) => !closed.some(({ corridor, by_person }) => corridor === name && by_person));
  const choices = open
    .map(({ name }) => ({ value: name, label: corridorTitle(map, name) }))
    .sort((one, other) => one.label.localeCompare(other.label, undefined, { numeric: true }));
  return {
    ...{ name: "close_corridor", reason: "needed", choices, chosen: choices[0]?.value, danger: true },
    run: ({ choice, reason }) => api.closeCorridor(choice, reason),
  };
}

/** @param {CampusMap} map @param {ClosedCorridor} closed @returns {Action} */
export function openAgain(map, { corridor, robots }) {
  const names = { corridor: corridorTitle(map, corridor), robots: robots.join(", ") };
  return { names, name: robots.length ? "reopen_found" : "reopen", run: () => api.openCorridor(corridor) };
}

/** True if its corridors can be released: the robot is offline, or stands. @param {Robot} robot */
export const canReleaseCorridors = ({ online, activity, heard_at, taken_out_at }) =>
  heard_at !== null && !taken_out_at && (!online || activity === "stopped");

/** @param {string} robot @returns {Action} */
export const takeOut = (robot) => ({
  names: { robot },
  ...{ name: "take_out", reason: "needed", suggestion: t("mailroom.do.take_out.suggestion"), danger: true },
  run: ({ reason }) => api.takeRobotOut(robot, reason).catch(inItsWords("take_out", { robot })),
});
