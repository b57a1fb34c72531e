/**
 * From metres to a drawing: where posts and corridors lie, and the frame around all of it with its names. Lengths
 * are units of the drawing at its plain size; a map is worked out once.
 * @import { CampusMap, MapCorridor, MapPost } from "../../types/api_types.ts"
 * @typedef {{x: number, y: number}} Point
 * @typedef {{x: number, y: number, width: number, height: number}} Box
 * @typedef {MapPost & Point} DrawnPost
 * @typedef {MapCorridor & {points: Point[]}} DrawnCorridor
 * @typedef {{posts: readonly DrawnPost[], corridors: readonly DrawnCorridor[], frame: Box}} Drawing
 */
import { bayBoxes } from "./map_bays.js";
import { placeLabels } from "./map_labels.js";

/** Units of drawing per post and direction: a map of many posts needs more room for their names. */
const ROOM = { width: 82, height: 100 };
/** Around all of it: room for robots that stand on the outermost posts. */
const MARGIN = 28;
/** As wide as a phone: a narrower frame would only be blown up, and what is noted beside posts needs the room. */
const NARROWEST = 384;

/** @template {WeakKey} Key @template Value @param {(key: Key) => Value} make @returns {(key: Key) => Value} */
export function onceFor(make) {
  /** @type {WeakMap<Key, Value>} */
  const made = new WeakMap();
  return (key) => {
    const known = made.get(key);
    if (known !== undefined) return known;
    const value = make(key);
    made.set(key, value);
    return value;
  };
}

/** Puts the campus into a space that grows with its posts, north up. */
export const drawing = onceFor((/** @type {CampusMap} */ map) => {
  const placed = place(map);
  const names = placed.posts.map(({ name, title }) => ({ name, title, notes: [], important: true, robots: 0 }));
  const { boxes } = placeLabels(placed, names, null);
  const points = [...placed.posts, ...placed.corridors.flatMap(({ points }) => points)];
  const frame = around([...boxes, ...placed.posts.flatMap(bayBoxes), ...points.map(({ x, y }) => ({ x, y, width: 0, height: 0 }))]);
  return { ...placed, frame };
});

/** @param {CampusMap} map */
function place(map) {
  const all = [...map.posts.map((post) => [post.x_m, post.y_m]), ...map.corridors.flatMap((corridor) => corridor.tape)];
  const [west, east] = ends(all.map(([x_m]) => x_m));
  const [south, north] = ends(all.map(([, y_m]) => y_m));
  const room = Math.sqrt(map.posts.length);
  const scale = Math.min((ROOM.width * room) / (east - west || 1), (ROOM.height * room) / (north - south || 1));
  /** @param {number} x_m @param {number} y_m @returns {Point} */
  const at = (x_m, y_m) => ({ x: (x_m - west) * scale, y: (north - y_m) * scale });
  return {
    posts: map.posts.map((post) => ({ ...post, ...at(post.x_m, post.y_m) })),
    corridors: map.corridors.map((corridor) => ({ ...corridor, points: corridor.tape.map(([x_m, y_m]) => at(x_m, y_m)) })),
  };
}

/**
 * The same, spread: places further from each other by this factor. The last one is kept, as most redraw it.
 * @param {Drawing} drawn @param {number} factor @returns {Drawing}
 */
export function spread(drawn, factor) {
  const last = lastSpread.get(drawn);
  if (last?.factor === factor) return last.result;
  const result = {
    posts: drawn.posts.map((post) => ({ ...post, ...times(post, factor) })),
    corridors: drawn.corridors.map((corridor) => ({ ...corridor, points: corridor.points.map((point) => times(point, factor)) })),
    frame: { ...times(drawn.frame, factor), width: drawn.frame.width * factor, height: drawn.frame.height * factor },
  };
  lastSpread.set(drawn, { factor, result });
  return result;
}

/** @type {WeakMap<Drawing, {factor: number, result: Drawing}>} */
const lastSpread = new WeakMap();

/** @param {Point} point @param {number} factor */
const times = ({ x, y }, factor) => ({ x: x * factor, y: y * factor });

/** @param {number[]} values @returns {[number, number]} */
const ends = (values) => [Math.min(...values), Math.max(...values)];

/** @param {Box[]} boxes @returns {Box} */
function around(boxes) {
  const [left, right] = ends(boxes.flatMap((box) => [box.x, box.x + box.width]));
  const [top, bottom] = ends(boxes.flatMap((box) => [box.y, box.y + box.height]));
  const width = Math.max(right - left + 2 * MARGIN, NARROWEST);
  return { x: (left + right - width) / 2, y: top - MARGIN, width, height: bottom - top + 2 * MARGIN };
}

/** The corridor between two neighbours in the direction of travel. @param {Drawing} drawn @param {string} from @param {string} to @returns {Point[]} */
export function pointsFrom(drawn, from, to) {
  const corridor = drawn.corridors.find(({ a, b }) => (a === from && b === to) || (b === from && a === to));
  if (!corridor) return [];
  return corridor.a === from ? corridor.points : [...corridor.points].reverse();
}

/** The middle of a way, and the direction there in degrees. @param {Point[]} points */
export const middleOf = (points) => along(points, 0.5);

/** A part of a way from its start, and the direction there in degrees. @param {Point[]} points @param {number} part 0 to 1 */
export function along(points, part) {
  const lengths = points.slice(1).map((end, i) => Math.hypot(end.x - points[i].x, end.y - points[i].y));
  let left = lengths.reduce((sum, length) => sum + length, 0) * Math.min(part, 0.9999);
  const i = lengths.findIndex((length) => (left -= length) <= 0);
  const [a, b] = [points[i], points[i + 1]];
  return { ...between(a, b, 1 + left / (lengths[i] || 1)), degrees: (Math.atan2(b.y - a.y, b.x - a.x) * 180) / Math.PI };
}

/** @param {Point} a @param {Point} b @param {number} part 0 at a, 1 at b @returns {Point} */
export const between = (a, b, part) => ({ x: a.x + (b.x - a.x) * part, y: a.y + (b.y - a.y) * part });

/** @param {readonly Point[]} points the `d` of a path */
export const pathOf = (points) => "M" + points.map(({ x, y }) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L");
