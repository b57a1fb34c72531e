/**
 * The service, as the pages see it. The only file that knows its URLs.
 * Every function answers with what the service sent, or throws `ApiProblem` (it said no) or `NoAnswer` (it said nothing).
 * @import * as Api from "./api_types.ts"
 */

const BASE = "/api/v1";

/** The service refused: `code` is stable and has a text, `detail` is its own sentence (RFC 9457). */
export class ApiProblem extends Error {
  /** @param {number} status
   *  @param {{code?: string, title?: string, detail?: string, errors?: {field: string, message: string}[]}} body */
  constructor(status, body) {
    super(body.detail ?? body.title ?? `HTTP ${status}`);
    this.status = status;
    this.code = body.code ?? "unknown";
    /** The fields of the request that were not understood, without the "body." before them. */
    this.fields = (body.errors ?? []).map(({ field }) => field.replace(/^body\./, ""));
  }
}

/** No answer came: no network, or no service. Whether the request arrived is not known. */
export class NoAnswer extends Error {}

/**
 * @param {string} path
 * @param {{method?: string, body?: unknown, headers?: Record<string, string>}} [request]
 * @returns {Promise<any>} the JSON of the answer, or null where it has none
 */
async function ask(path, { method = "GET", body, headers = {} } = {}) {
  const answer = await send(path, {
    method,
    headers: { Accept: "application/json", ...(body ? { "Content-Type": "application/json" } : {}), ...headers },
    body: body ? JSON.stringify(body) : undefined,
  });
  if (!answer.ok) throw new ApiProblem(answer.status, await answer.json().catch(() => ({})));
  return answer.status === 204 ? null : answer.json();
}

/** @param {string} path @param {RequestInit} request */
async function send(path, request) {
  try {
    return await fetch(BASE + path, request);
  } catch (error) {
    throw new NoAnswer(String(error));
  }
}

/** @param {Record<string, string | number | undefined>} fields */
const query = (fields) =>
  "?" + new URLSearchParams(Object.entries(fields).flatMap(([name, value]) => (value === undefined ? [] : [[name, `${value}`]])));

/** @param {string} id */
const orderPath = (id) => `/orders/${encodeURIComponent(id)}`;

/** @returns {Promise<Api.About>} */
export const about = () => ask("/about");

/** @returns {Promise<Api.Person | null>} who is signed in here, null for nobody */
export async function me() {
  try {
    return await ask("/me");
  } catch (problem) {
    if (problem instanceof ApiProblem && problem.status === 401) return null;
    throw problem;
  }
}

/** Where a browser goes to sign in at the campus itself; it comes back to `/`. */
export const CAMPUS_SIGN_IN = `${BASE}/sign-in/oidc`;

/** Have a code mailed. @param {string} email @returns {Promise<{expires_at: string}>} */
export const requestCode = (email) => ask("/sign-in/codes", { method: "POST", body: { email } });

/** @param {string} email @param {string} code @returns {Promise<Api.Person>} */
export const signIn = (email, code) => ask("/sign-in", { method: "POST", body: { email, code } });

/** @returns {Promise<null>} */
export const signOut = () => ask("/session", { method: "DELETE" });

/** @returns {Promise<Api.CampusMap>} */
export const campusMap = () => ask("/map");

/** @param {string} from_post @param {string} to_post @returns {Promise<Api.Estimate>} */
export const estimate = (from_post, to_post) => ask("/estimate" + query({ from_post, to_post }));

/** @param {Api.WantedOrder} wanted @param {string} key one per order: repeating it repeats the answer, not the order
 *  @returns {Promise<Api.Order>} */
export const placeOrder = (wanted, key) =>
  ask("/orders", { method: "POST", body: wanted, headers: { "Idempotency-Key": key } });

/** @param {"sent" | "coming" | "all"} role @param {{limit?: number, cursor?: string}} [page]
 *  @returns {Promise<Api.Page<Api.Order>>} newest first */
export const orders = (role, page = {}) => ask("/orders" + query({ role, ...page }));

/** @param {string} id @returns {Promise<Api.Order>} */
export const order = (id) => ask(orderPath(id));

/** @param {string} id @returns {Promise<Api.Order>} */
export const cancelOrder = (id) => ask(orderPath(id) + "/cancel", { method: "POST" });

/** My code, with the address of its picture. @param {string} id @returns {Promise<Api.ShownCode>} */
export async function handoverCode(id) {
  const code = await ask(orderPath(id) + "/code");
  return { ...code, picture: code.svg_url };
}

/** Ask the robot that waits to hand over, without a code. @param {string} id @returns {Promise<unknown>} */
export const handOver = (id) => ask(orderPath(id) + "/handover", { method: "POST", body: {} });

/** What the link in a mail opens. @param {string} what @param {string} token */
const askByLink = (what, token) => ask("/link/" + what, { method: "POST", body: { token } });

/** @param {string} token @returns {Promise<Api.Order>} */
export const linkedOrder = (token) => askByLink("order", token);

/** @param {string} token @returns {Promise<Api.ShownCode>} */
export async function linkedCode(token) {
  const { code, svg } = await askByLink("code", token);
  return { ...code, picture: "data:image/svg+xml," + encodeURIComponent(svg) };
}

/** @param {string} token @returns {Promise<unknown>} */
export const linkedHandOver = (token) => askByLink("handover", token);

/** The recipient cannot come: the robot brings it back. @param {string} token @returns {Promise<Api.Order>} */
export const linkedNotNow = (token) => askByLink("not-now", token);

/** @returns {Promise<Api.Robot[]>} all of them, page after page */
export async function robots() {
  const found = [];
  for (let cursor = ""; cursor !== null; ) {
    const page = await ask("/robots" + query({ limit: 100, cursor }));
    found.push(...page.items);
    cursor = page.next;
  }
  return found;
}

/** @param {{limit?: number, cursor?: string}} [page] @returns {Promise<Api.Inbox>} newest first */
export const notices = (page = { limit: 50 }) => ask("/notices" + query(page));

/** @param {Api.Notice["id"][]} ids @returns {Promise<unknown>} */
export const markRead = (ids) => ask("/notices/read", { method: "POST", body: { ids } });

/** Demonstration only: somebody holds my code of this order to the simulated camera. @param {string} order_id */
export const showCodeToCamera = (order_id) => ask("/demo/camera", { method: "POST", body: { order_id } });

/** What changes for me from now on, as named events. */
export const openLive = () => new EventSource(BASE + "/live");
