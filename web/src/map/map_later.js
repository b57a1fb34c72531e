/** The map comes after the words: fetched with its styles at once, or when it comes into view. */
import { withStyles } from "../elements/styles_later.js";

const BEFORE = "200px";

/** In this order: without its styles a map is black shapes for a moment. */
export const fetchMap = () => withStyles("/src/styles/map.css").then(() => import("./campus_map.js"));

/** @param {Element} place where it has its room */
export function fetchMapWhenSeen(place) {
  const eye = new IntersectionObserver(
    (seen) => {
      if (!seen.some(({ isIntersecting }) => isIntersecting)) return;
      eye.disconnect();
      fetchMap();
    },
    { rootMargin: BEFORE },
  );
  eye.observe(place);
}
