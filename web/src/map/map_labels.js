/**
 * Where the names of posts stand, and what is noted there: where they cover least.
 * @import { Box, DrawnCorridor, DrawnPost } from "./map_drawing.js"
 * @import { Side } from "./map_sides.js"
 * @typedef {{name: string, title: string, notes: readonly string[], important: boolean, robots: number}} Wording what
 *   stands beside a post, and how many robots stand on it; what is not important is left out where it has no room
 * @typedef {{x: number, y: number, anchor: "start" | "end" | "middle", folded: boolean}} Place from its post on, the first
 *   line's start; `folded`: long notes in two lines each
 * @typedef {{posts: readonly DrawnPost[], corridors: readonly DrawnCorridor[]}} Places
 * @typedef {{name: string, important: boolean, post: DrawnPost, room: Box | null, sides: Side[]}} Choosing
 */
import { COVERED, Obstacles, within } from "./map_obstacles.js";
import { sidesOf } from "./map_sides.js";

/** Rounds in which each label searches a better place once the others have theirs. */
const ROUNDS = 4;
/** Attempts, each in another order. */
const ATTEMPTS = 4;

/**
 * Finds every label the side of its post where it covers least: no corridor, no post, no other label.
 * @param {Places} drawn @param {readonly Wording[]} wordings in the order in which they may choose, but that those with
 *   fewer good sides choose before others that matter as much
 * @param {Box | null} frame that none of a post in it may leave @param {readonly Box[]} [kept] clear for something else
 * @returns {{places: Map<string, Place>, boxes: Box[]}}
 */
export function placeLabels(drawn, wordings, frame, kept = []) {
  const obstacles = new Obstacles(drawn, wordings, kept);
  const all = wordings.flatMap((wording) => {
    const post = drawn.posts.find(({ name }) => name === wording.name);
    const room = post && frame && within({ ...post, width: 0, height: 0 }, frame) ? frame : null;
    return post ? [{ name: wording.name, important: wording.important, post, room, sides: sidesOf(post, wording, room) }] : [];
  });
  const { taken } = bestOf(obstacles, fewestFirst(obstacles, all));
  return {
    places: new Map([...taken].map(([{ name }, { place }]) => [name, place])),
    boxes: [...taken.values()].map(({ box }) => box),
  };
}

/** @param {Obstacles} obstacles @param {Choosing[]} all */
function fewestFirst(obstacles, all) {
  const good = new Map(all.map((one) => [one, one.sides.filter(({ box }) => !obstacles.under(box, one.post, one.room, [], 1)).length]));
  return all.sort((a, b) => Number(b.important) - Number(a.important) || (good.get(a) ?? 0) - (good.get(b) ?? 0));
}

/** Those that matter and cover something choose first in the next attempt. @param {Obstacles} obstacles @param {Choosing[]} order */
function bestOf(obstacles, order) {
  let best = new Attempt(obstacles, order);
  let { stuck } = best;
  for (let attempt = 1; stuck.length && attempt < ATTEMPTS; attempt += 1) {
    order = [...stuck, ...order.filter((one) => !stuck.includes(one))];
    const next = new Attempt(obstacles, order);
    stuck = next.stuck;
    if (next.cost < best.cost) best = next;
  }
  return best;
}

/** Place the labels in one order; of those that do not matter, the ones that cover nothing. */
class Attempt {
  /** @type {Map<Choosing, Side>} */
  taken = new Map();

  /** @param {Obstacles} obstacles @param {Choosing[]} order */
  constructor(obstacles, order) {
    this.obstacles = obstacles;
    for (let round = 0; round < ROUNDS; round += 1) if (!order.map((one) => this.#choose(one)).includes(true)) break;
    for (const one of order) if (!one.important && this.#costOf(one) >= COVERED) this.taken.delete(one);
    const costs = order.filter(({ important }) => important).map((one) => ({ one, cost: this.#costOf(one) }));
    this.stuck = costs.filter(({ cost }) => cost >= COVERED).map(({ one }) => one);
    this.cost = costs.reduce((sum, { cost }) => sum + cost, 0);
  }

  /** Takes the best place there is now; whether it is another one than before. @param {Choosing} one */
  #choose(one) {
    const before = this.taken.get(one);
    this.taken.delete(one);
    let [best, least] = [before, Infinity];
    for (const side of one.sides) {
      if (side.dislike >= least) break;
      const cost = side.dislike + this.#under(side, one, least - side.dislike);
      if (cost < least) [best, least] = [side, cost];
    }
    if (best) this.taken.set(one, best);
    return best !== before;
  }

  /** The cost of a label at its place. @param {Choosing} one */
  #costOf(one) {
    const side = this.taken.get(one);
    if (!side) return 0;
    this.taken.delete(one);
    const cost = this.#under(side, one);
    this.taken.set(one, side);
    return cost;
  }

  /** @param {Side} side @param {Choosing} one @param {number} [most] */
  #under({ box }, { post, room }, most) {
    return this.obstacles.under(box, post, room, this.taken.values(), most);
  }
}
