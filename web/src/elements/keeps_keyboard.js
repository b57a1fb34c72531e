/**
 * Keeps the keyboard focus on the page: when the focused element is gone, focus goes on at the heading of that part of
 * the page; when that only rests while something is done, it comes back. Fetched at the first key that is pressed.
 */

/** @type {HTMLElement | null} what has the keyboard, and is seen to have it */
let here = null;
/** Its ancestors, nearest first: some of them remain when it is gone. @type {Element[]} */
let around = [];
let rests = false;

export function keepKeyboard() {
  remember(document.activeElement);
  document.addEventListener("focusin", ({ target }) => remember(target));
  new MutationObserver(look).observe(document.body, { subtree: true, childList: true, attributeFilter: ["disabled"] });
}

/** @param {EventTarget | null} target */
function remember(target) {
  here = target instanceof HTMLElement && target.matches(":focus-visible") ? target : null;
  around = placesAround(here);
  rests = false;
}

/** @param {Element | null} element */
function placesAround(element) {
  const places = [];
  for (let one = element?.parentElement; one; one = one.parentElement) places.push(one);
  return places;
}

function look() {
  if (!here) return;
  if (here.isConnected && here.matches(":disabled")) rests = true;
  else if (here.isConnected && rests) goOn(here);
  else if (!here.isConnected) goOn(headingNear());
}

/** Once the page has had its time to say itself where it goes on. @param {HTMLElement | null | undefined} place */
async function goOn(place) {
  const gone = here;
  await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
  const isNowhere = document.activeElement === null || document.activeElement === document.body;
  if (!place || !isNowhere || here !== gone) return;
  if (!place.matches("a, button, input, select, summary")) place.tabIndex = -1;
  place.focus();
}

function headingNear() {
  const left = around.filter(({ isConnected }) => isConnected);
  const headings = left.map((place) => /** @type {HTMLElement | null} */ (place.querySelector("h1, h2, h3")));
  return headings.find((heading) => heading?.checkVisibility());
}
