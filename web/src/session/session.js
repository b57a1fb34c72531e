/** Who is signed in on this page, what this browser remembers for them, and what goes with them when they sign out. */
import * as api from "../service/api.js";
import { leaving } from "./session_lost.js";
/** @import { Person } from "../../types/api_types.ts" */

/** @type {Person | null} */
let person = null;

/** @param {Person | null} who */
export function beginSession(who) {
  person = who;
}

export const personHere = () => person;

/** Whether this device keeps unsent orders of anybody: said here for whoever cannot wait for the outbox to be opened. */
const KEPT = "orders-kept";
export const hasKept = () => localStorage.getItem(KEPT) !== null;

/** @param {boolean} some */
export const sayKept = (some) => (some ? localStorage.setItem(KEPT, "") : localStorage.removeItem(KEPT));

/** Where this browser remembers whom it shows notices, and as what the service knows it. */
export const PUSH_DEVICE = "push-device";
export const hasPush = () => localStorage.getItem(PUSH_DEVICE) !== null;

/** Whether somebody is told how it goes: on asking, and without as long as they have sent nothing and not put it away. */
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

/** Nothing of theirs stays on the device but orders that wait to be sent: those wait for them. */
export async function signOut() {
  const [{ endPush }, { inSession }] = await Promise.all([import("../offline/push.js"), import("../offline/outbox.js")]);
  await leaving(async () => {
    await endPush().catch(() => undefined);
    await inSession(api.signOut).catch(unlessSignedOut);
  });
  await Promise.all([caches.delete("answers"), caches.delete("links"), navigator.clearAppBadge?.()]).catch(() => undefined);
}

/** A session that had ended already is as good as one that ends now. @param {unknown} failure */
function unlessSignedOut(failure) {
  if (!(failure instanceof api.ApiProblem && failure.status === 401)) throw failure;
}
