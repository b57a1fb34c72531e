/**
 * From metres to a drawing: where posts, corridors and labels lie. Pure: nothing here touches the page.
 * @import { CampusMap } from "./api_types.ts"
 * @typedef {{x: number, y: number}} Point
 * @typedef {{x: number, y: number, width: number, height: number}} Box
 * @typedef {{x: number, y: number, anchor: "start" | "end" | "middle", lines: string[]}} Label
 * @typedef {{name: string, lines: string[]}} Wording what stands beside a post, line by line
 */

/** Units of drawing per post and direction: a map of many posts needs more room for their names. */
const ROOM = { width: 82, height: 100 };
const MARGIN = 18;
const LINE_HEIGHT = 15;
const CHARACTER_WIDTH = 7.2;
const GAP = 19;

/** Puts the campus into a space that grows with its posts, north up. @param {CampusMap} map */
export function drawing(map) {
  const all = [...map.posts.map((post) => [post.x_m, post.y_m]), ...map.corridors.flatMap((corridor) => corridor.tape)];
  const [west, east] = ends(all.map(([x_m]) => x_m));
  const [south, north] = ends(all.map(([, y_m]) => y_m));
  const room = Math.sqrt(map.posts.length);
  const scale = Math.min((ROOM.width * room) / (east - west || 1), (ROOM.height * room) / (north - south || 1));
  /** @param {number} x_m @param {number} y_m @returns {Point} */
  const place = (x_m, y_m) => ({ x: (x_m - west) * scale, y: (north - y_m) * scale });
  return {
    posts: map.posts.map((post) => ({ ...post, ...place(post.x_m, post.y_m) })),
    corridors: map.corridors.map((corridor) => ({
      ...corridor,
      points: corridor.tape.map(([x_m, y_m]) => place(x_m, y_m)),
    })),
  };
}

/** @param {number[]} values @returns {[number, number]} */
const ends = (values) => [Math.min(...values), Math.max(...values)];

/** A title in lines that are short enough to stand beside a post. @param {string} title */
export function inLines(title) {
  if (title.length <= 11) return [title];
  const spaces = [...title.matchAll(/ (?![/&–-])/g)].map(({ index }) => index);
  if (!spaces.length) return [title];
  const [middlemost] = spaces.sort((a, b) => Math.abs(a - title.length / 2) - Math.abs(b - title.length / 2));
  return [title.slice(0, middlemost), title.slice(middlemost + 1)];
}

/**
 * Finds every label the side of its post where it covers least: no corridor, no post, no other label.
 * @param {ReturnType<typeof drawing>} drawn @param {Wording[]} wordings in the order in which they may choose
 * @returns {{labels: Map<string, Label>, view: Box}} `view` holds everything that is drawn
 */
export function placeLabels(drawn, wordings) {
  const obstacles = [...drawn.corridors.flatMap(({ points }) => alongPath(points)), ...drawn.posts];
  /** @type {Box[]} */
  const taken = [];
  const labels = new Map();
  for (const { name, lines } of wordings) {
    const post = drawn.posts.find((candidate) => candidate.name === name);
    if (!post) continue;
    const sides = candidates(post, lines).map((side) => ({ ...side, cost: cost(side.box, obstacles, taken) + side.dislike }));
    const best = sides.reduce((a, b) => (b.cost < a.cost ? b : a));
    taken.push(best.box);
    labels.set(name, best.label);
  }
  return { labels, view: around([...taken, ...obstacles.map(({ x, y }) => ({ x, y, width: 0, height: 0 }))]) };
}

/** @param {Point} post @param {string[]} lines */
function candidates({ x, y }, lines) {
  const width = Math.max(...lines.map((line) => line.length)) * CHARACTER_WIDTH;
  const height = lines.length * LINE_HEIGHT;
  const middle = y - height / 2;
  const low = y - LINE_HEIGHT / 2;
  return [
    side("start", x + GAP, middle, 0),
    side("end", x - GAP, middle, 0.1),
    side("middle", x, y + GAP, 0.2),
    side("middle", x, y - GAP - height, 0.3),
    side("start", x + GAP, low + GAP, 0.4),
    side("end", x - GAP, low + GAP, 0.5),
    side("start", x + GAP, low - GAP - height + LINE_HEIGHT, 0.6),
    side("end", x - GAP, low - GAP - height + LINE_HEIGHT, 0.7),
  ];

  /** @param {Label["anchor"]} anchor @param {number} at @param {number} top @param {number} dislike */
  function side(anchor, at, top, dislike) {
    const left = { start: at, end: at - width, middle: at - width / 2 }[anchor];
    const label = { x: at, y: top + LINE_HEIGHT * 0.76, anchor, lines };
    return { box: { x: left, y: top, width, height }, label, dislike };
  }
}

/** @param {Box} box @param {Point[]} obstacles @param {Box[]} taken */
const cost = (box, obstacles, taken) =>
  obstacles.filter((point) => inside(point, box)).length + 20 * taken.filter((other) => overlap(box, other)).length;

/** @param {Point} point @param {Box} box */
const inside = ({ x, y }, box) =>
  x > box.x - 4 && x < box.x + box.width + 4 && y > box.y - 3 && y < box.y + box.height + 3;

/** @param {Box} a @param {Box} b */
const overlap = (a, b) => a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/** Points along a line, close enough that no label slips between them. @param {Point[]} points */
const alongPath = (points) =>
  points.slice(1).flatMap((end, i) => {
    const steps = Math.ceil(Math.hypot(end.x - points[i].x, end.y - points[i].y) / 5);
    return Array.from({ length: steps + 1 }, (_, step) => between(points[i], end, step / steps));
  });

/** @param {Point} a @param {Point} b @param {number} part 0 at a, 1 at b @returns {Point} */
export const between = (a, b, part) => ({ x: a.x + (b.x - a.x) * part, y: a.y + (b.y - a.y) * part });

/** @param {Box[]} boxes @returns {Box} */
function around(boxes) {
  const [left, right] = ends(boxes.flatMap((box) => [box.x, box.x + box.width]));
  const [top, bottom] = ends(boxes.flatMap((box) => [box.y, box.y + box.height]));
  return { x: left - MARGIN, y: top - MARGIN, width: right - left + 2 * MARGIN, height: bottom - top + 2 * MARGIN };
}
