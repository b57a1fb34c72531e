/** Puts the service worker in, once the page stands, and says when a new version of the pages is there. */
import { hasPush } from "../session/session.js";
/** @import { Person } from "../../types/api_types.ts" */
/** @import { Heard } from "./kept_answers.js" */

/** The event of a new version: `take` changes to it. @typedef {CustomEvent<{take: () => void}>} NewVersion */

/** @param {Person | null} person */
export async function workOffline(person) {
  if (!("serviceWorker" in navigator)) return;
  const wasControlled = navigator.serviceWorker.controller !== null;
  const registration = await registered();
  if (!registration) return;
  // One that is only coming does so by itself.
  if (person) registration.active?.postMessage("keep at hand");
  const look = () => registration.active && registration.waiting && sayNewVersion(() => takeOver(registration));
  look();
  registration.addEventListener("updatefound", () => registration.installing?.addEventListener("statechange", look));
  // Another page has changed to it: this one goes on with its own files until its person likes to change too.
  navigator.serviceWorker.addEventListener("controllerchange", () => wasControlled && sayNewVersion(() => location.reload()));
  if (person && hasPush()) await (await import("./push.js")).checkPush(person.id);
}

/** Where a browser has no workers made of modules, or its person wants none, pages work as long as there is a network. */
const registered = () =>
  navigator.serviceWorker.register("/service_worker.js", { type: "module", updateViaCache: "none" }).catch(() => undefined);

/** Send the worker a change received by an open page, to be kept. @param {Heard} heard */
export function tellWorker(heard) {
  if (heard.order.my_role !== "dispatcher") navigator.serviceWorker?.controller?.postMessage(heard);
}

/** @param {() => void} take */
const sayNewVersion = (take) => dispatchEvent(new CustomEvent("new-version", { detail: { take } }));

/** @param {ServiceWorkerRegistration} registration */
function takeOver(registration) {
  navigator.serviceWorker.addEventListener("controllerchange", () => location.reload());
  registration.waiting?.postMessage("take over");
}
