/**
 * The notes beside each post of a map, and other areas to be kept clear.
 * @import { CampusMap, Expected, Robot, OccupiedCorridor } from "../../types/api_types.ts"
 * @import { Box, Drawing } from "./map_drawing.js"
 * @import { MapFacts } from "./map_facts.js"
 * @import { Wording } from "./map_labels.js"
 */
import { middleOf, pointsFrom } from "./map_drawing.js";
import { conditionsOf, nextPost } from "./map_facts.js";
import { shortestWay } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago, windowText } from "../texts/times.js";

/** Posts that matter most choose their side first. @param {CampusMap} map @param {MapFacts} facts
 *  @param {readonly string[]} ends of the way that is shown @returns {Wording[]} */
export function wordingsOf(map, { seen, standing, reported, expected, robots, arrival }, ends) {
  return map.posts
    .map(({ name, title, dock, mailroom }) => {
      const [here, coming] = [seen.get(name) ?? [], expected.get(name) ?? []];
      const important = ends.includes(name) || here.length + coming.length > 0;
      const rank = (important ? 4 : 0) + (mailroom ? 2 : 0) + (dock ? 1 : 0);
      return { name, title, notes: notesOf(here, coming, reported, robots.length === 1, arrival), important, robots: standing.get(name)?.length ?? 0, rank };
    })
    .sort((a, b) => b.rank - a.rank);
}

/** The note at a post about the robots there: one line each, the rest is in the list. @param {readonly Robot[]} seen @param {readonly Robot[]} expected
 *  @param {MapFacts["reported"]} reported @param {boolean} alone @param {MapFacts["arrival"]} arrival */
function notesOf(seen, expected, reported, alone, arrival) {
  const now_ms = serverNow();
  return [
    ...seen.flatMap((robot) => {
      const conditions = conditionsOf(robot).map((condition) => t(`map.is.${condition}`));
      const age = ago(lastWord(robot, reported), now_ms);
      return alone ? [t("map.seen_here"), age, ...conditions] : [[robot.name, ...conditions, age].join(" · ")];
    }),
    ...expected.flatMap((robot) =>
      alone ? [t("map.expected_here"), windowText(arrival?.window ?? /** @type {Expected} */ (robot.expected), now_ms)] : [t("map.robot.expected", { robot: robot.name })],
    ),
  ];
}

/** When it was last seen, or reported to be there. @param {Robot} robot @param {MapFacts["reported"]} reported */
function lastWord({ name, last_seen }, reported) {
  const told = reported.find(({ robot }) => robot === name)?.at ?? "";
  return last_seen && Date.parse(last_seen.at) >= (Date.parse(told) || 0) ? last_seen.at : told;
}

/** The posts between which a robot must be by now. @param {CampusMap} map @param {Robot} robot */
export function aheadOf(map, robot) {
  const [seen, next] = [robot.last_seen?.post, nextPost(robot)];
  return seen && next && seen !== next ? shortestWay(map, seen, next) : [];
}

/** Room for a robot in a corridor, or the name of who holds it. @param {Drawing} drawn
 *  @param {Pick<OccupiedCorridor, "robot" | "from_post" | "to_post">} sign @returns {Box} */
export function signBox(drawn, { robot, from_post, to_post }) {
  const points = pointsFrom(drawn, from_post, to_post);
  const { x, y } = points.length ? middleOf(points) : { x: 0, y: 0 };
  const width = Math.max(24, robot.length * 7 + 6);
  return { x: x - width / 2, y: y - 26, width, height: 38 };
}
