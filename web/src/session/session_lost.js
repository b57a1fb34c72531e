/**
 * Handles a session that has ended without a sign-out: the person signs in again over the page, and it
 * goes on as it was; where another person does, nothing of the first stays. All tabs of a browser know by one entry of its
 * storage who is here; docs/decisions/0070 says why.
 * @typedef {CustomEvent<"lost" | "back">} SessionEvent tells elements, as `session` of the window
 */
import * as api from "../service/api.js";
import { PAGES } from "../service/links.js";
import { goOnLive, stopLive } from "../live/live.js";
/** @import { Person } from "../../types/api_types.ts" */

/** The person whose page was opened last, and when: the same person again is news, too. */
const HERE = "signed-in";
const LEAVING = "leaving";

/** The person who is signed in on this page. @type {string | null} */
let person_id = null;
let isLeaving = false;
/** Callbacks of requests that wait for the session, called with its outcome. @type {((isBack: boolean) => void)[] | null} null: it was not lost */
let waiting = null;
let isPutAway = false;

/** @param {Person | null} person */
export function keepSession(person) {
  person_id = person?.id ?? null;
  if (person_id) sayHere(person_id);
  addEventListener("storage", ({ key, newValue }) => key === HERE && hear(newValue));
  // A page that was put away has heard nothing meanwhile.
  addEventListener("pageshow", ({ persisted }) => persisted && whoIsIn(localStorage.getItem(HERE)) !== person_id && leave());
  api.whenSessionIsLost(lost);
}

export const isLost = () => waiting !== null;

/** Now, or once the session is back. @param {() => unknown} act */
export function whenBack(act) {
  if (!waiting) return void act();
  const hear = (/** @type {Event} */ event) => (/** @type {SessionEvent} */ (event).detail === "back" ? act() : whenBack(act));
  addEventListener("session", hear, { once: true });
}

/** Ask to sign in, anew where that was put away. */
export function askAgain() {
  isPutAway = false;
  tell("lost");
}

/** Its person goes on without: what waits is refused. */
export function putAway() {
  isPutAway = true;
  settle(false);
}

/** Go on after a sign-in over this page. @param {Person} person */
export function signedIn({ id }) {
  sayHere(id);
  hear(localStorage.getItem(HERE));
}

/** Signing out on purpose: no tab asks to sign in again. @param {() => Promise<unknown>} act */
export async function leaving(act) {
  isLeaving = true;
  localStorage.setItem(HERE, LEAVING);
  try {
    await act();
    localStorage.removeItem(HERE);
  } catch (failure) {
    isLeaving = false;
    if (person_id) sayHere(person_id);
    throw failure;
  }
}

/** @param {string} id */
const sayHere = (id) => localStorage.setItem(HERE, `${id} ${Date.now()}`);

/** @param {string | null} said */
const whoIsIn = (said) => said?.split(" ")[0] ?? null;

/** @param {string | null} said by another tab */
function hear(said) {
  isLeaving = said === LEAVING;
  const id = whoIsIn(said);
  if (isLeaving || (id === person_id && !waiting)) return;
  if (id && id === person_id) back(id);
  else if (person_id) leave();
  else location.reload();
}

/** Its address may tell of the previous person. */
function leave() {
  stopLive();
  location.replace(PAGES.order);
}

/** @param {boolean} isAct @returns {Promise<boolean>} */
function lost(isAct) {
  if (!person_id || isLeaving) return Promise.resolve(false);
  const isNews = !waiting;
  if (isNews) stopLive();
  waiting ??= [];
  if (isNews || isAct) askAgain();
  if (isPutAway) return Promise.resolve(false);
  return new Promise((resolve) => waiting?.push(resolve));
}

/** @param {string} id */
function back(id) {
  settle(true);
  waiting = null;
  goOnLive(id);
  tell("back");
}

/** @param {boolean} isBack */
const settle = (isBack) => waiting?.splice(0).forEach((resolve) => resolve(isBack));

/** @param {"lost" | "back"} detail */
const tell = (detail) => dispatchEvent(new CustomEvent("session", { detail }));
