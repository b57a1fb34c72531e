/**
 * Obstacles for labels on a map, and the cost of covering each.
 * @import { Box, DrawnPost, Point } from "./map_drawing.js"
 * @import { Places, Wording } from "./map_labels.js"
 */
import { bayBoxes } from "./map_bays.js";
import { crowdRadius } from "./map_sides.js";

/** Between two labels side by side. */
const APART = 6;
/** Between words and a line, beside and above. */
const CLEAR = { x: 4, y: 3 };
/** Around a post that is not its own. */
const NEAR = 9;
/** From so much on something is covered. */
export const COVERED = 10;
/** The cost of being nearer to another post than to its own, as if it were that one's name; to cover a line, and each unit of
 *  it; to cover a post; to lie outside of the frame; to cover words: words on a line can be read, words on words cannot. */
const COSTS = { mistaken: 6, line: COVERED, unit: 0.2, post: 20, outside: 45, words: 60 };

export class Obstacles {
  /** @param {Places} drawn @param {readonly Wording[]} wordings @param {readonly Box[]} kept */
  constructor({ posts, corridors }, wordings, kept) {
    this.kept = kept;
    this.posts = posts;
    this.lines = corridors.flatMap(({ points }) => points.slice(1).map((end, i) => ({ start: points[i], end })));
    const robots = new Map(wordings.map((wording) => [wording.name, wording.robots]));
    this.around = posts.map((post) => ({ name: post.name, ...around(post, robots.get(post.name) ?? 0) }));
    this.bays = posts.flatMap(bayBoxes);
  }

  /** The cost of a label of this post here; counting stops beyond `most`. @param {Box} box @param {DrawnPost} post
   *  @param {Box | null} room @param {Iterable<{box: Box}>} labels that stand already @param {number} [most] */
  under(box, post, room, labels, most = Infinity) {
    let cost = room && !within(box, room) ? COSTS.outside : 0;
    for (const words of this.kept) if (overlap(box, words)) cost += COSTS.words;
    for (const label of labels) if (overlap(box, label.box)) cost += COSTS.words;
    for (const bay of this.bays) if (overlap(box, bay)) cost += COSTS.post;
    for (const other of this.around) if (other.name !== post.name && overlap(box, other)) cost += COSTS.post;
    return cost < most ? cost + this.#lines(box) + this.#mistaken(box, post) : cost;
  }

  /** @param {Box} box */
  #lines(box) {
    let cost = 0;
    for (const { start, end } of this.lines) {
      const length = lengthIn(start, end, box);
      if (length) cost += COSTS.line + COSTS.unit * length;
    }
    return cost;
  }

  /** @param {Box} box @param {DrawnPost} post */
  #mistaken(box, post) {
    const own = distance(post, box);
    return this.posts.some((other) => other.name !== post.name && distance(other, box) <= own) ? COSTS.mistaken : 0;
  }
}

/** The room of a post and of the robots that stand on it. @param {Point} post @param {number} robots @returns {Box} */
function around({ x, y }, robots) {
  const half = robots ? crowdRadius(robots) : NEAR;
  return { x: x - half, y: y - half, width: 2 * half, height: 2 * half };
}

/** The length of a line near a box. @param {Point} a @param {Point} b @param {Box} box */
function lengthIn(a, b, { x, y, width, height }) {
  const [right, down] = [b.x - a.x, b.y - a.y];
  const [left, far] = [(x - CLEAR.x - a.x) / right, (x + width + CLEAR.x - a.x) / right];
  const [top, low] = [(y - CLEAR.y - a.y) / down, (y + height + CLEAR.y - a.y) / down];
  const from = Math.max(0, Math.min(left, far), Math.min(top, low));
  const to = Math.min(1, Math.max(left, far), Math.max(top, low));
  return to > from ? (to - from) * Math.hypot(right, down) : 0;
}

/** @param {Point} point @param {Box} box */
const distance = ({ x, y }, box) => Math.hypot(Math.max(box.x - x, 0, x - box.x - box.width), Math.max(box.y - y, 0, y - box.y - box.height));

/** @param {Box} box @param {Box} frame */
export const within = (box, frame) =>
  box.x >= frame.x && box.y >= frame.y && box.x + box.width <= frame.x + frame.width && box.y + box.height <= frame.y + frame.height;

/** @param {Box} a @param {Box} b */
const overlap = (a, b) => a.x < b.x + b.width + APART && b.x < a.x + a.width + APART && a.y < b.y + b.height && b.y < a.y + a.height;
