/** Signing out, and what it removes from this browser. */
import { inSession } from "../offline/outbox.js";
import { endPush } from "../offline/push.js";
import * as api from "../service/api.js";
import { leaving } from "./session_lost.js";

/** Sign out and remove all personal data from this device, except unsent orders: those are sent when the person returns. */
export async function signOut() {
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
