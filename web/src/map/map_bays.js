/**
 * Bays on a drawing: spurs off a post, and what is at their ends.
 * @import { CampusMap, MapPost } from "../../types/api_types.ts"
 * @import { Box, DrawnPost, Point } from "./map_drawing.js"
 * @typedef {MapPost["bays"][number] & Point & {number: number}} DrawnBay from its post on; counted from 1, as in titles
 */
import { svg } from "lit";

/** Longer than spurs are, so that robots in two bays of a post can be told apart. */
const SPUR = 27;
/** Of a robot in a bay, or of what is drawn at the end of an empty one. */
const HALF = 12;

/** None where robots stand on the post itself; a phone may have kept the map of an older service.
 *  @param {MapPost} post @returns {MapPost["bays"]} */
export const baysOf = ({ bays }) => bays ?? [];

/** @param {MapPost} post @returns {DrawnBay[]} */
export const drawnBays = (post) =>
  baysOf(post).map((bay, i) => {
    const [right, up] = [bay.x_m - post.x_m, bay.y_m - post.y_m];
    const part = SPUR / (Math.hypot(right, up) || 1);
    return { ...bay, x: right * part, y: -up * part, number: i + 1 };
  });

/** @param {DrawnPost} post @returns {Box[]} what the bays of a post cover */
export const bayBoxes = (post) =>
  drawnBays(post).map(({ x, y }) => ({ x: post.x + x - HALF, y: post.y + y - HALF, width: 2 * HALF, height: 2 * HALF }));

/** @param {CampusMap} map @param {string} place a bay or a post @returns {{post: MapPost, number: number} | null} `number` of
 *  the bay; 0: the post itself */
export function placeNamed(map, place) {
  for (const post of map.posts) {
    const number = baysOf(post).findIndex(({ name }) => name === place) + 1;
    if (number || post.name === place) return { post, number };
  }
  return null;
}

const HOUSE = svg`<path class="home" d="M-5 5v-5.500l5-4.500 5 4.500v5z" />`;
const DOCK = svg`<rect class="dock" x="-9" y="-9" width="18" height="18" rx="5" />`;
const FREE = svg`<circle class="bay" r="4" />`;

/** Spurs and the ends of them. @param {readonly DrawnBay[]} bays */
export const bayMarks = (bays) =>
  bays.map(
    ({ name, x, y, home, dock }) => svg`<path class="spur" d="M0 0L${x.toFixed(1)} ${y.toFixed(1)}" />
      <g data-bay=${name} transform="translate(${x.toFixed(1)} ${y.toFixed(1)})">${bayMark(home, dock)}</g>`,
  );

/** @param {boolean} home @param {boolean} dock */
export const bayMark = (home, dock) => [dock ? DOCK : "", home ? HOUSE : dock ? "" : FREE];
