/** Who is signed in on this page, and what goes with them when they sign out. */
import * as api from "./api.js";
import { inSession } from "./outbox.js";
/** @import { Person } from "./api_types.ts" */

/** @type {Person | null} */
let person = null;

/** @param {Person | null} who */
export function beginSession(who) {
  person = who;
}

export const personHere = () => person;

/** Nothing of theirs stays on the device but orders that wait to be sent: those wait for them. */
export async function signOut() {
  const { endPush } = await import("./push.js");
  await endPush().catch(() => undefined);
  await inSession(api.signOut);
  await Promise.all([caches.delete("answers"), navigator.clearAppBadge?.()]).catch(() => undefined);
  person = null;
}
