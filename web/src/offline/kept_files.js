/** The pages' files, kept by version: a page is opened from them, with a network or without. */
import { FILES, VERSION } from "./page_files.js";

const PREFIX = "pages ";
const CURRENT = PREFIX + VERSION;
const FETCHED_AT_ONCE = 3;
/** Where a version remembers which pages were open when it took over: they go on with the files that they know. */
const OLD_PAGES = "/old-pages";
const known = new Set(FILES);

/** True if this version has the file. @param {URL} url @param {Request} request */
export const isFile = (url, request) => known.has(url.pathname) && (!url.search || request.mode === "navigate");

/** Cache all files or none. Some lanes stay free for what a person does meanwhile. */
export async function keepFiles() {
  const cache = await caches.open(CURRENT);
  const waiting = [...FILES];
  const lane = async () => {
    for (let address = waiting.shift(); address; address = waiting.shift()) {
      await cache.add(new Request(address, { cache: "no-cache" }));
    }
  };
  await Promise.all(Array.from({ length: FETCHED_AT_ONCE }, lane));
}

/** Older versions are dropped, unless a page of theirs is still open. @param {WorkerScope} worker */
export async function dropOldFiles(worker) {
  const pages = (await worker.clients.matchAll({ type: "window" })).map(({ id }) => id);
  const older = (await caches.keys()).filter((name) => name.startsWith(PREFIX) && name !== CURRENT);
  const kept = pages.length ? older.slice(-1) : [];
  await Promise.all(older.filter((name) => !kept.includes(name)).map((name) => caches.delete(name)));
  if (!kept.length) return;
  const cache = await caches.open(CURRENT);
  await cache.put(OLD_PAGES, Response.json({ pages, version: kept[0] }));
}

/** @param {URL} url @param {FetchedEvent} event */
export async function file(url, { request, clientId }) {
  const cache = await caches.open(CURRENT);
  const name = (clientId && (await olderVersion(cache, clientId))) || CURRENT;
  const kept = await caches.match(url.pathname, { cacheName: name, ignoreVary: true });
  return kept ?? fetch(request);
}

/** The version that a page was opened with, if it is not this one. @param {Cache} cache @param {string} page */
async function olderVersion(cache, page) {
  const told = await cache.match(OLD_PAGES);
  const old = /** @type {{pages: string[], version: string} | undefined} */ (await told?.json());
  return old?.pages.includes(page) ? old.version : null;
}
