/** The pieces of a drawn map. What each robot is, is told by its shape and beside it in words, not by colour alone. */
import { nothing, svg } from "lit";
import { bayMark, bayMarks, drawnBays } from "./map_bays.js";
import { middleOf, pathOf, pointsFrom } from "./map_drawing.js";
import { conditionsOf } from "./map_facts.js";
import { inCorridors } from "./map_places.js";
import { crowdRadius, inLines, LINE_HEIGHT, notesIn, robotPlaces } from "./map_sides.js";
/** @import { Robot, OccupiedCorridor } from "../../types/api_types.ts" */
/** @import { DrawnPost, Drawing } from "./map_drawing.js" */
/** @import { Place, Wording } from "./map_labels.js" */
/** @import { Between } from "./map_places.js" */

export const NO_WAY = svg`<circle r="8" /><path d="M-4.500 0h9" />`;

/** Corridors and posts without network, hatched. @param {Drawing} drawn @param {string} pattern its id on this page */
export const silentPlaces = ({ posts, corridors }, pattern) => svg`
  <pattern id=${pattern} width="6" height="6" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">
    <path class="hatch" d="M1.500 0V6" />
  </pattern>
  ${corridors.map(({ name, network, points }) =>
    network ? nothing : svg`<path class="silent" data-corridor=${name} stroke="url(#${pattern})" d=${pathOf(points)} />`,
  )}
  ${posts.map(({ name, network, x, y }) =>
    network ? nothing : svg`<circle class="silent" data-post=${name} fill="url(#${pattern})" cx=${x} cy=${y} r="20" />`,
  )}`;

/** @param {Drawing} drawn */
export const corridorLines = ({ corridors }) => corridors.map(({ points }) => svg`<path class="corridor" d=${pathOf(points)} />`);

/** @param {Drawing} drawn @param {readonly OccupiedCorridor[]} taken */
export const occupiedBands = (drawn, taken) =>
  taken.map(({ robot, corridor, from_post, to_post }) => {
    const points = pointsFrom(drawn, from_post, to_post);
    const d = pathOf(points);
    return points.length ? svg`<path class="taken-edge" d=${d} /><path class="taken" data-robot=${robot} data-corridor=${corridor} d=${d} />` : nothing;
  });

/** Which way each of them is taken, and by whom where there are several robots. @param {Drawing} drawn
 *  @param {readonly OccupiedCorridor[]} taken @param {boolean} named */
export const occupiedSigns = (drawn, taken, named) =>
  taken.map(({ robot, from_post, to_post }) => {
    const points = pointsFrom(drawn, from_post, to_post);
    if (!points.length) return nothing;
    const { x, y, degrees } = middleOf(points);
    return svg`<g class="holder" transform="translate(${x} ${y})">
      <path transform="rotate(${degrees})" d="M-4 -5.500 5 0l-9 5.500z" />
      ${named ? svg`<text y="-8" text-anchor="middle">${robot}</text>` : nothing}
    </g>`;
  });

/** Where no robot goes in. @param {Drawing} drawn @param {readonly string[]} closed */
export const closedSigns = (drawn, closed) =>
  drawn.corridors
    .filter(({ name }) => closed.includes(name))
    .map(({ name, points }) => {
      const { x, y } = middleOf(points);
      return svg`<g class="shut" data-corridor=${name} transform="translate(${x} ${y})">${NO_WAY}</g>`;
    });

/** @param {Drawing} drawn @param {readonly string[]} posts @param {"way" | "ahead"} kind */
export const wayLines = (drawn, posts, kind) =>
  posts.slice(1).map((there, i) => {
    const points = pointsFrom(drawn, posts[i], there);
    return points.length ? svg`<path class=${kind} d=${pathOf(points)} />` : nothing;
  });

/** @param {DrawnPost} post @param {{isEnd: boolean, isGoal: boolean, seen: readonly Robot[], expected: readonly Robot[], inBays: Map<string, Robot[]>}} here
 *  `seen` on the post itself */
export const postMark = (post, { isEnd, isGoal, seen, expected, inBays }) => {
  const { name, x, y, dock } = post;
  const bays = drawnBays(post);
  return svg`<g transform="translate(${x} ${y})">
    ${bayMarks(bays)}
    ${dock && !bays.length ? bayMark(false, true) : nothing}
    <circle class=${isEnd ? "post end" : "post"} r=${isEnd ? 7 : 5.5} />
    ${isGoal ? svg`<circle class="goal" r="3" />` : nothing}
    ${seen.length ? svg`<circle class="aura" r=${crowdRadius(seen.length)} />` : nothing}
    ${expected.length ? svg`<circle class="expected" data-post=${name} data-robots=${namesOf(expected)} r=${seen.length ? crowdRadius(seen.length) + 3 : 12} />` : nothing}
    ${robotPlaces(seen.length).map((place, i) => robotMark(seen[i], place, { post: name }))}
    ${bays.map((bay) => (inBays.get(bay.name) ?? []).map((robot, i) => robotMark(robot, { x: bay.x + 6 * i, y: bay.y + 6 * i }, { post: name, bay: bay.name })))}
  </g>`;
};

/** A robot in the corridor that it reports to be in, the way it goes, and its name. @param {Drawing} drawn
 *  @param {readonly Between[]} between @param {boolean} named */
export const drivingMarks = (drawn, between, named) =>
  inCorridors(drawn, between).map(({ robot, corridor, x, y, degrees }) => svg`
    <g class="driving" transform="translate(${x} ${y})">
      <path class="heads" transform="rotate(${degrees})" d="M13 -5.500 22 0l-9 5.500z" />
      ${robotMark(robot, { x: 0, y: 0 }, { corridor })}
      ${named ? svg`<text y="-15" text-anchor="middle">${robot.name}</text>` : nothing}
    </g>`);

/** @param {readonly Robot[]} robots */
const namesOf = (robots) => robots.map(({ name }) => name).join(" ");

const FACE = svg`<path class="face" d="M-5 -2.500a3 3 0 0 1 3-3h4a3 3 0 0 1 3 3v5a3 3 0 0 1-3 3h-4a3 3 0 0 1-3-3zM-1.8 -.5v1M1.8 -.5v1M0 -5.500v-2" />`;
const BODY = {
  moving: svg`<circle class="body" r="11" />`,
  stopped: svg`<path class="body" d="M-4.500 -11h9l6.500 6.500v9l-6.500 6.500h-9l-6.500-6.500v-9z" />`,
};
const BOLT = svg`<g class="bolt" transform="translate(8.500 -8.500)"><circle r="6" /><path d="M1 -4-2.500 .8H0L-1 4 2.500 -.8H0z" /></g>`;

/** An octagon stands still, a broken outline is silent, a bolt charges. @param {Robot} robot @param {{x: number, y: number}} place
 *  @param {{post?: string, bay?: string, corridor?: string}} at */
function robotMark(robot, { x, y }, { post, bay, corridor }) {
  const conditions = conditionsOf(robot);
  return svg`<g class=${["robot", ...conditions].join(" ")} data-robot=${robot.name} data-post=${post ?? nothing} data-bay=${bay ?? nothing}
    data-corridor=${corridor ?? nothing} transform="translate(${x} ${y})">
    <title>${robot.name}</title>
    ${conditions.includes("stopped") ? BODY.stopped : BODY.moving}${FACE}${conditions.includes("charging") ? BOLT : nothing}
  </g>`;
}

/** @param {DrawnPost} post @param {Wording} wording @param {Place} place */
export function label(post, wording, place) {
  const titles = inLines(wording.title);
  const x = post.x + place.x;
  return svg`<text class="label" x=${x} y=${post.y + place.y} text-anchor=${place.anchor}>${[...titles, ...notesIn(wording, place.folded)].map(
    (line, i) => svg`<tspan class=${i < titles.length ? "name" : "note"} x=${x} dy=${i ? LINE_HEIGHT : 0}>${line}</tspan>`,
  )}</text>`;
}
