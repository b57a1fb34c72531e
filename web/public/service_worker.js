/**
 * Keeps the pages at hand without a network: their files by version, the few answers that help a person in a tunnel,
 * orders that could not be sent, and notices that are pushed. What each part keeps is said in
 * docs/decisions/0037-what-a-phone-keeps.md. Its address gives it all pages and must not change; `../src` is `/src` here,
 * since an address has nothing above its root.
 */
import { changesSession, isKeptOffline } from "../src/service/api.js";
import { SYNC_TAG, sendKept } from "../src/offline/outbox.js";
import { keepAtHand, keepMoreAtHand } from "../src/offline/at_hand.js";
import { answer, forgetAll, isHeard, keepHeard } from "../src/offline/kept_answers.js";
import { dropOldFiles, file, isFile, keepFiles } from "../src/offline/kept_files.js";
import { open, renewSubscription, show } from "../src/offline/pushed.js";

const worker = /** @type {WorkerScope} */ (/** @type {unknown} */ (self));

worker.addEventListener("install", (event) => event.waitUntil(keepFiles().then(keepAtHand)));
worker.addEventListener("activate", (event) => event.waitUntil(dropOldFiles(worker).then(() => worker.clients.claim())));
worker.addEventListener("message", (event) => event.data === "take over" && worker.skipWaiting());
worker.addEventListener("message", (event) => event.data === "keep at hand" && event.waitUntil(keepMoreAtHand()));
worker.addEventListener("message", (event) => isHeard(event.data) && event.waitUntil(keepHeard(event.data)));
worker.addEventListener("push", (event) => event.waitUntil(show(worker, event.data)));
worker.addEventListener("notificationclick", (event) => event.waitUntil(open(worker, event.notification)));
worker.addEventListener("pushsubscriptionchange", (event) => event.waitUntil(renewSubscription(worker)));
worker.addEventListener("sync", (event) => event.tag === SYNC_TAG && event.waitUntil(sendKept()));

worker.addEventListener("fetch", (event) => {
  const url = new URL(event.request.url);
  if (url.origin !== location.origin) return;
  if (changesSession(event.request.method, url)) event.waitUntil(forgetAll());
  else if (event.request.method !== "GET") return;
  else if (isFile(url, event.request)) event.respondWith(file(url, event));
  else if (isKeptOffline(url) && event.request.cache !== "no-store") event.respondWith(answer(event));
});
