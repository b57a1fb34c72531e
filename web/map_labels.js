/**
 * Where the names of posts stand, and what is noted there: where they cover least. Pure.
 * @import { Box, DrawnCorridor, DrawnPost, Point } from "./map_drawing.js"
 * @typedef {{name: string, title: string, notes: readonly string[], important: boolean, robots: number}} Wording what
 *   stands beside a post, and how many robots stand on it; what is not important is left out where it has no room
 * @typedef {{x: number, y: number, anchor: "start" | "end" | "middle", folded: boolean}} Place from its post on, the first
 *   line's start; `folded`: long notes in two lines each
 * @typedef {{posts: readonly DrawnPost[], corridors: readonly DrawnCorridor[]}} Places
 */

export const LINE_HEIGHT = 15;
const CHARACTER_WIDTH = { title: 7.7, note: 6.7 };
/** From a post's middle to its label. */
const GAP = 19;
/** Of each of several robots at one post. */
const ROBOT_ROOM = 25;
/** Between two labels side by side. */
const APART = 6;
/** Around a post that is not its own: nearer to it a name would be taken for that post's. */
const NEAR = 9;
/** What it costs to cover a post or other words, or to lie outside of the frame; a point of a corridor costs 1: words on
 *  a line can be read, words on words cannot. */
const COVERS = 20;
const COVERS_WORDS = 60;
const OUTSIDE = 45;
/** What it costs to need more lines. */
const FOLDED = 2;

/** A title in lines that are short enough to stand beside a post. @param {string} title */
export function inLines(title) {
  if (title.length <= 11) return [title];
  const spaces = [...title.matchAll(/ (?![/&–-])/g)].map(({ index }) => index);
  if (!spaces.length) return [title];
  const [middlemost] = spaces.sort((a, b) => Math.abs(a - title.length / 2) - Math.abs(b - title.length / 2));
  return [title.slice(0, middlemost), title.slice(middlemost + 1)];
}

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

/**
 * Finds every label the side of its post where it covers least: no corridor, no post, no other label.
 * @param {Places} drawn @param {readonly Wording[]} wordings in the order in which they may choose, but that those with
 *   fewer good sides choose before others that matter as much
 * @param {Box | null} frame that none of a post in it may leave @param {readonly Box[]} [kept] clear for something else
 * @returns {{places: Map<string, Place>, boxes: Box[]}}
 */
export function placeLabels(drawn, wordings, frame, kept = []) {
  const obstacles = drawn.corridors.flatMap(({ points }) => alongPath(points));
  const posts = new Map(drawn.posts.map((post) => [post.name, post]));
  const around = wordings.flatMap(({ name, robots }) => occupied(posts.get(name), robots));
  const places = new Map();
  /** @type {Box[]} */
  const taken = [];
  const choosing = wordings.map((wording) => ({ wording, good: sidesOf(wording).filter(({ cost }) => cost < 1).length }));
  choosing.sort((a, b) => Number(b.wording.important) - Number(a.wording.important) || a.good - b.good);
  for (const { wording } of choosing) {
    const sides = sidesOf(wording);
    if (!sides.length) continue;
    const best = sides.reduce((a, b) => (b.cost < a.cost ? b : a));
    if (best.cost >= COVERS && !wording.important) continue;
    taken.push(best.box);
    places.set(wording.name, best.place);
  }
  return { places, boxes: taken };

  /** @param {Wording} wording */
  function sidesOf(wording) {
    const post = posts.get(wording.name);
    if (!post) return [];
    const room = frame && within({ ...post, width: 0, height: 0 }, frame) ? frame : null;
    return foldings(wording)
      .flatMap((folded) => candidates(post, wording, folded, room))
      .map((side) => ({ ...side, cost: side.dislike + cost(side.box, wording.name, room) }));
  }

  /** @param {Box} box @param {string} own @param {Box | null} room */
  function cost(box, own, room) {
    const words = [...taken, ...kept].filter((other) => overlap(box, other)).length;
    const others = around.filter((other) => other.name !== own && overlap(box, other)).length;
    const outside = room && !within(box, room) ? OUTSIDE : 0;
    return obstacles.filter((point) => inside(point, box)).length + COVERS_WORDS * words + COVERS * others + outside;
  }
}

/** @param {Pick<Wording, "notes">} wording @param {boolean} folded */
export const notesIn = ({ notes }, folded) => (folded ? notes.flatMap((note) => note.split(/(?<= · [^·]*) · /)) : notes);

/** @param {Wording} wording */
const foldings = (wording) => (notesIn(wording, true).length > wording.notes.length ? [false, true] : [false]);

/** A circle around so many robots. @param {number} count */
export const crowdRadius = (count) => (count > 1 ? Math.max(...robotPlaces(count).map(({ x, y }) => Math.hypot(x, y))) + 15 : 17);

/** The room of a post and of the robots that stand on it. @param {DrawnPost | undefined} post @param {number} robots @returns {(Box & {name: string})[]} */
function occupied(post, robots) {
  if (!post) return [];
  const half = robots ? crowdRadius(robots) : NEAR;
  return [{ name: post.name, x: post.x - half, y: post.y - half, width: 2 * half, height: 2 * half }];
}

/** @param {Point} post @param {Wording} wording @param {boolean} folded @param {Box | null} frame */
function candidates({ x, y }, wording, folded, frame) {
  const lines = inLines(wording.title);
  const notes = notesIn(wording, folded);
  const widths = [...lines.map((line) => line.length * CHARACTER_WIDTH.title), ...notes.map((note) => note.length * CHARACTER_WIDTH.note)];
  const width = Math.max(...widths);
  const height = (lines.length + notes.length) * LINE_HEIGHT;
  const gap = wording.robots > 1 ? crowdRadius(wording.robots) + 7 : GAP;
  const low = y - LINE_HEIGHT / 2;
  return [
    side("start", x + gap, y - height / 2, 0),
    side("end", x - gap, y - height / 2, 0.1),
    side("middle", x, y + gap, 0.2),
    side("middle", x, y - gap - height, 0.3),
    side("start", x + gap, low + gap, 0.4),
    side("end", x - gap, low + gap, 0.5),
    side("start", x + gap, low - gap - height + LINE_HEIGHT, 0.6),
    side("end", x - gap, low - gap - height + LINE_HEIGHT, 0.7),
  ];

  /** @param {Place["anchor"]} anchor @param {number} at @param {number} top @param {number} dislike */
  function side(anchor, at, top, dislike) {
    const wanted = { start: at, end: at - width, middle: at - width / 2 }[anchor];
    const left = anchor === "middle" && frame ? pushedInto(frame, wanted, width) : wanted;
    const box = { x: left, y: top, width, height };
    return { box, place: { x: at + left - wanted - x, y: top + LINE_HEIGHT * 0.76 - y, anchor, folded }, dislike: dislike + (folded ? FOLDED : 0) };
  }
}

/** @param {Box} frame @param {number} left @param {number} width */
const pushedInto = (frame, left, width) => Math.max(frame.x + 2, Math.min(left, frame.x + frame.width - width - 2));

/** @param {Point} point @param {Box} box */
const inside = ({ x, y }, box) =>
  x > box.x - 4 && x < box.x + box.width + 4 && y > box.y - 3 && y < box.y + box.height + 3;

/** @param {Box} box @param {Box} frame */
const within = (box, frame) =>
  box.x >= frame.x && box.y >= frame.y && box.x + box.width <= frame.x + frame.width && box.y + box.height <= frame.y + frame.height;

/** @param {Box} a @param {Box} b */
const overlap = (a, b) => a.x < b.x + b.width + APART && b.x < a.x + a.width + APART && a.y < b.y + b.height && b.y < a.y + a.height;

/** Points along a line, close enough that no label slips between them. @param {readonly Point[]} points */
const alongPath = (points) =>
  points.slice(1).flatMap((end, i) => {
    const steps = Math.ceil(Math.hypot(end.x - points[i].x, end.y - points[i].y) / 5);
    return Array.from({ length: steps + 1 }, (_, step) => ({
      x: points[i].x + ((end.x - points[i].x) * step) / steps,
      y: points[i].y + ((end.y - points[i].y) * step) / steps,
    }));
  });
