/** Parts of a page that are fetched when they come into view: a phone's first screen is there sooner. */

const BEFORE = "200px";

/** @param {Element} element @param {() => Promise<unknown>} load */
export function whenSeen(element, load) {
  const eye = new IntersectionObserver(
    (seen) => {
      if (!seen.some(({ isIntersecting }) => isIntersecting)) return;
      eye.disconnect();
      load();
    },
    { rootMargin: BEFORE },
  );
  eye.observe(element);
}
