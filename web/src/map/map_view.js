/**
 * Which part of a map is seen: its middle, and how close. Pure arithmetic; lengths are units of the drawing.
 * @import { Box, Point } from "./map_drawing.js"
 * @typedef {{x: number, y: number, zoom: number}} View zoom 1 shows the whole
 */

export const CLOSEST = 6;
/** The zoom of "go to robot". */
const NEAR = 2.5;
/** Around what is to be seen. */
const ROOM = 95;
/** Pixels of a plain letter that can just be read, and that are comfortable. */
const LETTER = { drawn: 13, readable: 10 };

/** @param {Box} frame @returns {View} */
export const whole = (frame) => ({ x: frame.x + frame.width / 2, y: frame.y + frame.height / 2, zoom: 1 });

/** Closer or farther by a factor; `at` stays where it is. @param {View} view @param {Box} frame @param {number} factor @param {Point} [at] */
export function zoomed(view, frame, factor, at = view) {
  const zoom = clamp(view.zoom * factor, 1, CLOSEST);
  const part = view.zoom / zoom;
  return within({ x: at.x + (view.x - at.x) * part, y: at.y + (view.y - at.y) * part, zoom }, frame);
}

/** @param {View} view @param {Box} frame @param {number} dx @param {number} dy */
export const moved = (view, frame, dx, dy) => within({ ...view, x: view.x + dx, y: view.y + dy }, frame);

/** The closest view that shows all of these points. @param {readonly Point[]} points @param {Box} frame @returns {View} */
export function showing(points, frame) {
  if (!points.length) return whole(frame);
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const [left, right, top, bottom] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const fitting = Math.min(frame.width / (right - left + 2 * ROOM), frame.height / (bottom - top + 2 * ROOM));
  return within({ x: (left + right) / 2, y: (top + bottom) / 2, zoom: clamp(fitting, 1, NEAR) }, frame);
}

/** Part of the way from one view to another. @param {View} from @param {View} to @param {number} part @returns {View} */
export function onTheWay(from, to, part) {
  if (part >= 1) return to;
  const zoom = from.zoom * (to.zoom / from.zoom) ** part;
  return { x: from.x + (to.x - from.x) * part, y: from.y + (to.y - from.y) * part, zoom };
}

/** Nothing is looked at beyond the frame. @param {View} view @param {Box} frame @returns {View} */
function within({ x, y, zoom }, frame) {
  const [halfWidth, halfHeight] = [frame.width / 2 / zoom, frame.height / 2 / zoom];
  return {
    x: clamp(x, frame.x + halfWidth, frame.x + frame.width - halfWidth),
    y: clamp(y, frame.y + halfHeight, frame.y + frame.height - halfHeight),
    zoom,
  };
}

/**
 * The scale of posts, lines and letters: on a small screen letters grow with the zoom until they
 * have their full size, and are never too small to be read.
 * @param {number} pixels of the screen per unit at zoom 1 @param {number} zoom
 */
export const sizeOf = (pixels, zoom) => Math.max(1, LETTER.readable / LETTER.drawn / pixels, Math.min(zoom, 1 / pixels));

/** The scale of distances, in units of letters and lines. @param {View} view @param {number} size */
export const spreadOf = (view, size) => view.zoom / size;

/** @param {View} view @param {Box} frame @param {number} size @returns {Box} in the units of the spread drawing */
export function windowOf(view, frame, size) {
  const [width, height] = [frame.width / size, frame.height / size];
  const factor = spreadOf(view, size);
  return { x: view.x * factor - width / 2, y: view.y * factor - height / 2, width, height };
}

/** @param {number} value @param {number} least @param {number} most */
const clamp = (value, least, most) => Math.min(Math.max(value, least), Math.max(least, most));
