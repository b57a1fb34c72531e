/** The person who is signed in on this page, and what this browser remembers for them. */
/** @import { Person } from "../../types/api_types.ts" */

/** @type {Person | null} */
let person = null;

/** @param {Person | null} who */
export function beginSession(who) {
  person = who;
}

export const personHere = () => person;

/** A flag that this device keeps unsent orders: readable without opening the outbox. */
const KEPT = "orders-kept";
export const hasKept = () => localStorage.getItem(KEPT) !== null;

/** @param {boolean} some */
export const sayKept = (some) => (some ? localStorage.setItem(KEPT, "") : localStorage.removeItem(KEPT));

/** Where this browser remembers whom it shows notifications, and as what the service knows it. */
export const PUSH_DEVICE = "push-device";
export const hasPush = () => localStorage.getItem(PUSH_DEVICE) !== null;

/** The guide is shown on request, and to new senders until they dismiss it. */
const PUT_AWAY = "first-steps-put-away";

/** @param {boolean} isNew */
export const wantsFirstHelp = (isNew) =>
  new URLSearchParams(location.search).has("help") || (isNew && localStorage.getItem(PUT_AWAY) === null);

/** Never again by itself. */
export function putFirstHelpAway() {
  localStorage.setItem(PUT_AWAY, "yes");
  const here = new URL(location.href);
  here.searchParams.delete("help");
  history.replaceState(history.state, "", here);
}

/** Tells whenever the outbox has changed, by whichever page or worker. @param {() => void} tell @returns {() => void} an end to it */
export function onKept(tell) {
  const channel = new BroadcastChannel("outbox");
  channel.onmessage = tell;
  return () => channel.close();
}
