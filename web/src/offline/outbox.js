/**
 * Orders that the service has not answered yet. Each has its key and its person, and survives the page, the tab and the
 * browser; it is sent until there is an answer, under the session of the person who placed it and under no other.
 * One that was refused is sent again only when its person says so. Page and worker use the same box.
 * @import { WantedOrder } from "../../types/api_types.ts"
 * @typedef {{status: number, code: string, detail: string, fields: string[]}} Refusal
 * @typedef {{key: string, person_id: string, wanted: WantedOrder, at: string, order_id: string | null, refusal: Refusal | null}} KeptOrder
 *   waiting, or sent as `order_id`, or refused
 */
import * as api from "../service/api.js";

export const SYNC_TAG = "orders";
const LOCK = "session";
const BOX = "orders";
/** The service knows a key for a day; after that, sending it again might be a second order. */
const SENT_BY_ITSELF_MS = 23 * 3_600_000;
const changes = typeof BroadcastChannel === "undefined" ? null : new BroadcastChannel("outbox");

/** @returns {Promise<IDBDatabase>} */
function database() {
  const opening = indexedDB.open("campus-mail", 1);
  opening.onupgradeneeded = () => opening.result.createObjectStore(BOX, { keyPath: "key" });
  return settled(opening);
}

/** @template T @param {IDBRequest<T>} request @returns {Promise<T>} */
const settled = (request) =>
  new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
  });

/** @template T @param {IDBTransactionMode} mode @param {(box: IDBObjectStore) => IDBRequest<T>} use @returns {Promise<T>} */
async function inBox(mode, use) {
  const opened = await database();
  try {
    return await settled(use(opened.transaction(BOX, mode).objectStore(BOX)));
  } finally {
    opened.close();
  }
}

/** Oldest first. @param {string} person_id @returns {Promise<KeptOrder[]>} */
export async function keptOrders(person_id) {
  const all = /** @type {KeptOrder[]} */ (await inBox("readonly", (box) => box.getAll()));
  return all.filter((kept) => kept.person_id === person_id).sort((a, b) => a.at.localeCompare(b.at));
}

/** True if there are any, of any person. */
export const anyKept = async () => (await inBox("readonly", (box) => box.count())) > 0;

/** @param {KeptOrder} kept */
export const keep = (kept) => inBox("readwrite", (box) => box.put(kept));

/** Neither sent nor refused. @param {KeptOrder} kept */
export const isWaiting = (kept) => !kept.order_id && !kept.refusal;

/** Every page shows what is kept now. */
export const announce = () => changes?.postMessage("changed");

/** @param {string} key */
export async function discard(key) {
  await inBox("readwrite", (box) => box.delete(key));
  announce();
}

/** Hold off sign-in and sign-out while an order is being sent. @template T @param {() => Promise<T>} act @returns {Promise<T>} */
export const inSession = async (act) => await (navigator.locks ? navigator.locks.request(LOCK, act) : act());

/** No network, a gateway without its service, or a first request that still runs: sending it again by itself is safe.
 *  @param {unknown} problem */
export const isPassing = (problem) =>
  problem instanceof api.NoAnswer ||
  (problem instanceof api.ApiProblem && ([502, 503, 504].includes(problem.status) || problem.code === "still_running"));

/** True if the same order may be accepted later, unchanged; any other has to be corrected first.
 *  @param {Pick<Refusal, "status" | "code">} refusal */
export const isForLater = ({ status, code }) =>
  ([401, 409, 429].includes(status) || status >= 500) && code !== "idempotency_key_reused";

/** Send what waits of the person who is signed in. Throws NoAnswer where there is still no network. */
export const sendKept = () =>
  inSession(async () => {
    const person = await api.me({ fresh: true });
    if (!person) return;
    for (const kept of (await keptOrders(person.id)).filter(isWaiting)) await sendOne(kept);
    announce();
  });

/** Send a refused order, since its person says so. @param {KeptOrder} kept */
export const sendAgain = (kept) =>
  inSession(async () => {
    const person = await api.me({ fresh: true });
    if (person?.id !== kept.person_id) return refuse(kept, new api.ApiProblem(401, { code: "not_signed_in" }));
    const waiting = { ...kept, refusal: null };
    await keep(waiting);
    await sendOne(waiting);
  });

/** @param {KeptOrder} kept */
async function sendOne(kept) {
  const isOld = Date.now() - Date.parse(kept.at) > SENT_BY_ITSELF_MS;
  try {
    if (isOld) throw new api.ApiProblem(422, { code: "kept_too_long" });
    await keep({ ...kept, order_id: (await api.placeOrder(kept.wanted, kept.key)).id });
  } catch (problem) {
    await refuse(kept, problem);
  }
}

/** Keep it with the reason; what passes, and what is no answer, is thrown. @param {KeptOrder} kept @param {unknown} problem */
export async function refuse(kept, problem) {
  if (isPassing(problem) || !(problem instanceof api.ApiProblem)) throw problem;
  const { status, code, message, fields } = problem;
  await keep({ ...kept, refusal: { status, code, detail: message, fields } });
}

/** Has the worker send it as soon as there is a network, where browsers do that. */
export async function sendLater() {
  const registration = await navigator.serviceWorker?.getRegistration();
  await registration?.sync?.register(SYNC_TAG).catch(() => undefined);
}
