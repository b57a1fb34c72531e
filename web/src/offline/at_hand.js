/** Fetches what a person needs offline in one go, before the pages ask for it. */
import { aboutMe, anyList, forEverybody, myFirstContacts, myRunningOrders } from "../service/api.js";
import { fetchAndKeep, isKept } from "./kept_answers.js";

const NOT_LONGER_MS = 20_000;
/** Moving from page to page must not fetch a list each time. */
const NOT_BEFORE_MS = 60_000;

/** When the last one began, as far as this worker knows. */
let begun_ms = -Infinity;

/** Before a worker takes over for the first time its pages have asked without it. */
export const keepAtHand = () => Promise.allSettled([forAll(), forPerson()]);

/** A page has opened: what it did not ask for itself. */
export async function keepMoreAtHand() {
  if (performance.now() - begun_ms > NOT_BEFORE_MS || !(await isKept(anyList()))) await keepAtHand();
}

async function forAll() {
  await Promise.all((await missing(forEverybody())).map((url) => fetchAndKeep(url, inTime())));
}

/** Ask for the person first: nothing may be kept beside another person's data. */
async function forPerson() {
  begun_ms = performance.now();
  const signal = inTime();
  if (!(await fetchAndKeep(aboutMe(), signal))) return;
  const wanted = [...(await missing([myFirstContacts()])), ...myRunningOrders()];
  for (const url of wanted) await fetchAndKeep(url, signal);
}

const inTime = () => AbortSignal.timeout(NOT_LONGER_MS);

/** @param {URL[]} urls */
async function missing(urls) {
  const kept = await Promise.all(urls.map(isKept));
  return urls.filter((_, index) => !kept[index]);
}
