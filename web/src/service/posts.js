/** Titles of posts, and the shortest way between two of them. */
import * as api from "./api.js";
/** @import { CampusMap } from "../../types/api_types.ts" */

/** @type {Promise<CampusMap> | null} */
let asked = null;

/** The map, asked for once per page. */
export function loadMap() {
  asked ??= api.campusMap().catch((failure) => {
    asked = null;
    throw failure;
  });
  return asked;
}

/** A post's title; its name where this map does not know it. @param {CampusMap} map @param {string | null} name */
export const titleOf = (map, name) => map.posts.find((post) => post.name === name)?.title ?? name ?? "";

/** "Post 3 – Post 4" @param {CampusMap} map @param {string} corridor */
export function corridorTitle(map, corridor) {
  const ends = map.corridors.find(({ name }) => name === corridor);
  return ends ? `${titleOf(map, ends.a)} – ${titleOf(map, ends.b)}` : corridor;
}

/**
 * The posts of the shortest way by corridor lengths, ends included; empty where there is none.
 * The robot plans its own: it may go round something that is in its way.
 * @param {CampusMap} map @param {string} start @param {string} goal @returns {string[]}
 */
export function shortestWay(map, start, goal) {
  const ways = new Map([[start, { length_m: 0, posts: [start] }]]);
  const open = new Set([start]);
  while (open.size) {
    const here = [...open].reduce((a, b) => (reach(ways, a) <= reach(ways, b) ? a : b));
    open.delete(here);
    for (const { a, b, length_m } of map.corridors) {
      const there = a === here ? b : b === here ? a : null;
      const total_m = reach(ways, here) + length_m;
      if (there === null || total_m >= reach(ways, there)) continue;
      ways.set(there, { length_m: total_m, posts: [...(ways.get(here)?.posts ?? []), there] });
      open.add(there);
    }
  }
  return ways.get(goal)?.posts ?? [];
}

/** @param {Map<string, {length_m: number}>} ways @param {string} post */
const reach = (ways, post) => ways.get(post)?.length_m ?? Infinity;
