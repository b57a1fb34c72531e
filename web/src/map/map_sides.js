/**
 * The size of a label, and its possible places beside its post.
 * @import { Box, DrawnPost, Point } from "./map_drawing.js"
 * @import { Place, Wording } from "./map_labels.js"
 * @typedef {{box: Box, place: Place, dislike: number}} Side `dislike`: below 10, how much rather it stands elsewhere
 */

import { baysOf } from "./map_bays.js";

export const LINE_HEIGHT = 15;
/** As map.css has them. */
const FONTS = { title: "600 13px", note: "500 12px" };
/** From a post's middle to its label, and from several robots at it. */
const GAP = 19;
const BESIDE_ROBOTS = 7;
/** Of each of several robots at one post. */
const ROBOT_ROOM = 25;
/** Where there is no room beside the post, so much farther away. */
const FARTHER = [0, 6, 12, 18];
const BEYOND_BAYS = [...FARTHER, 24, 30];
/** Along its side: -1 is as far as its corner reaches one way, 1 the other way. */
const ALONG = Array.from({ length: 13 }, (_, i) => i / 6 - 1);
const DISLIKES = { left: 0.1, below: 0.2, above: 0.3, along: 0.4, farther: 0.1, folded: 2 };

/** A title in lines that are short enough to stand beside a post. @param {string} title */
export function inLines(title) {
  if (title.length <= 11) return [title];
  const spaces = [...title.matchAll(/ (?![/&–-])/g)].map(({ index }) => index);
  if (!spaces.length) return [title];
  const [middlemost] = spaces.sort((a, b) => Math.abs(a - title.length / 2) - Math.abs(b - title.length / 2));
  return [title.slice(0, middlemost), title.slice(middlemost + 1)];
}

/** @param {Pick<Wording, "notes">} wording @param {boolean} folded */
export const notesIn = ({ notes }, folded) => (folded ? notes.flatMap((note) => note.split(/(?<= · [^·]*) · /)) : notes);

/** Columns and rows in which several robots stand at one post. @param {number} count */
function gridOf(count) {
  const columns = Math.max(1, Math.ceil(Math.sqrt(count)));
  return { columns, rows: Math.ceil(count / columns) };
}

/** Where each of several robots stands, from its post on. @param {number} count @returns {Point[]} */
export function robotPlaces(count) {
  const { columns, rows } = gridOf(count);
  return Array.from({ length: count }, (_, i) => {
    const row = Math.floor(i / columns);
    const inRow = Math.min(columns, count - row * columns);
    return { x: ((i % columns) - (inRow - 1) / 2) * ROBOT_ROOM, y: (row - (rows - 1) / 2) * ROBOT_ROOM };
  });
}

/** A circle around so many robots. @param {number} count */
export const crowdRadius = (count) => (count > 1 ? Math.max(...robotPlaces(count).map(({ x, y }) => Math.hypot(x, y))) + 15 : 17);

/** @type {CanvasRenderingContext2D | null} */
let pen = null;
/** @type {Map<string, number>} */
const known = new Map();

/** The width of a text on this device. @param {keyof typeof FONTS} kind @param {string} text */
function widthOf(kind, text) {
  const key = kind + text;
  const width = known.get(key) ?? measured(kind, text);
  known.set(key, width);
  return width;
}

/** @param {keyof typeof FONTS} kind @param {string} text */
function measured(kind, text) {
  pen ??= /** @type {CanvasRenderingContext2D} */ (document.createElement("canvas").getContext("2d"));
  pen.font = `${FONTS[kind]} ${getComputedStyle(document.documentElement).fontFamily}`;
  return pen.measureText(text).width;
}

/** The places that a label may have, the best first. @param {DrawnPost} post @param {Wording} wording @param {Box | null} frame
 *  @returns {Side[]} */
export function sidesOf(post, wording, frame) {
  const foldings = notesIn(wording, true).length > wording.notes.length ? [false, true] : [false];
  return foldings.flatMap((folded) => sides(post, wording, folded, frame)).sort((a, b) => a.dislike - b.dislike);
}

/** @param {DrawnPost} post @param {Wording} wording @param {boolean} folded @param {Box | null} frame */
function sides(post, wording, folded, frame) {
  const { x, y } = post;
  const [titles, notes] = [inLines(wording.title), notesIn(wording, folded)];
  const width = Math.max(...titles.map((line) => widthOf("title", line)), ...notes.map((note) => widthOf("note", note)));
  const height = (titles.length + notes.length) * LINE_HEIGHT;
  const nearest = wording.robots > 1 ? crowdRadius(wording.robots) + BESIDE_ROBOTS : GAP;
  return (baysOf(post).length ? BEYOND_BAYS : FARTHER).flatMap((farther) => {
    const gap = nearest + farther;
    const reach = height / 2 + gap - LINE_HEIGHT / 2;
    return ALONG.flatMap((along) => {
      const dislike = DISLIKES.along * Math.abs(along) + DISLIKES.farther * farther + (folded ? DISLIKES.folded : 0);
      const [top, left] = [y - height / 2 + along * reach, x - width / 2 + (along * width) / 2];
      return [
        side("start", x + gap, top, dislike),
        side("end", x - gap - width, top, dislike + DISLIKES.left),
        side("middle", left, y + gap, dislike + DISLIKES.below),
        side("middle", left, y - gap - height, dislike + DISLIKES.above),
      ];
    });
  });

  /** @param {Place["anchor"]} anchor @param {number} wanted @param {number} top @param {number} dislike @returns {Side} */
  function side(anchor, wanted, top, dislike) {
    const left = anchor === "middle" && frame ? pushedInto(frame, wanted, width) : wanted;
    const at = left + { start: 0, middle: width / 2, end: width }[anchor];
    return { box: { x: left, y: top, width, height }, place: { x: at - x, y: top + LINE_HEIGHT * 0.76 - y, anchor, folded }, dislike };
  }
}

/** @param {Box} frame @param {number} left @param {number} width */
const pushedInto = (frame, left, width) => Math.max(frame.x + 2, Math.min(left, frame.x + frame.width - width - 2));
