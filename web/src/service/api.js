/**
 * The service, as the pages see it. The only file that knows its URLs.
 * Every function answers with what the service sent, or throws `ApiProblem` (it said no) or `NoAnswer` (it said nothing).
 * @import * as Api from "../../types/api_types.ts"
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
export class NoAnswer extends Error {
  /** True for requests that change nothing. */
  isQuestion = false;
}

/**
 * @param {string} path
 * @param {{method?: string, body?: unknown, headers?: Record<string, string>, cache?: RequestCache}} [request]
 * @returns {Promise<any>} the JSON of the answer, or null where it has none
 */
function ask(path, request = {}) {
  const answer = sendInSession(path, request);
  const read = answer.then(jsonOf);
  if (!request.method) notePosition(answer, read);
  return read;
}

/** @param {string} path @param {{method?: string, body?: unknown, headers?: Record<string, string>, cache?: RequestCache}} request */
async function send(path, { method = "GET", body, headers = {}, cache }) {
  /** @type {Record<string, string>} */
  const content = body ? { "Content-Type": "application/json" } : {};
  try {
    return await fetch(BASE + path, {
      method,
      cache,
      headers: { Accept: "application/json", ...content, ...headers },
      body: body ? JSON.stringify(body) : undefined,
    });
  } catch (error) {
    throw Object.assign(new NoAnswer(String(error)), { isQuestion: method === "GET" });
  }
}

/** The handler for a session that has ended. @type {((isAct: boolean) => Promise<boolean>) | null} */
let signInAgain = null;

/** @param {(isAct: boolean) => Promise<boolean>} act promises whether the same person is signed in again; `isAct`: whether
 *  something was to be done, not only asked */
export const whenSessionIsLost = (act) => (signInAgain = act);

/** A question is asked again once its person is signed in again; what was to be done is theirs to say again.
 * @param {string} path @param {{method?: string, body?: unknown, headers?: Record<string, string>, cache?: RequestCache}} request
 * @returns {Promise<Response>} */
async function sendInSession(path, request) {
  const answer = await send(path, request);
  if (answer.status !== 401 || !signInAgain || path.startsWith("/sign-in")) return answer;
  const isBack = signInAgain(Boolean(request.method));
  // Who is here is asked to know just that.
  const isHeld = !request.method && path !== "/me";
  return isHeld && (await isBack) ? sendInSession(path, request) : answer;
}

/** @param {Response} answer */
async function jsonOf(answer) {
  if (!answer.ok) throw new ApiProblem(answer.status, await answer.json().catch(() => ({})));
  return answer.status === 204 ? null : answer.json();
}

/** @typedef {string | null | undefined} Position a place in the event stream; null: not known; undefined: of nothing */

/** The oldest place at which something was read. @type {Promise<Position>} */
let oldestRead = Promise.resolve(undefined);

/** @param {Promise<Response>} answer @param {Promise<unknown>} read settled once the body is here, too */
function notePosition(answer, read) {
  const position = read.then(positionIn, positionIn);
  oldestRead = Promise.all([oldestRead, position]).then(([one, other]) => (one === undefined ? other : earlier(one, other)));

  /** A refusal is an answer as good as any. */
  function positionIn() {
    return answer.then(({ status, headers }) => (status < 500 ? headers.get("Feed-Position") : null), () => null);
  }
}

/** @param {Position} one @param {Position} other @returns {Position} null if they cannot be compared */
const earlier = (one, other) => (!isAfter(one, other) ? one : !isAfter(other, one) ? other : null) ?? null;

/** From where on the event stream tells everything that has changed since what was asked for after the last call was read.
 * @returns {Promise<Position>} null where an answer is missing: only asking anew helps */
export function positionOfAnswers() {
  const position = oldestRead;
  oldestRead = Promise.resolve(undefined);
  return position;
}

/** True if `one` comes later in the stream. A place that is not known, or of another run of the service, may.
 *  @param {Position} one @param {Position} other */
export function isAfter(one, other) {
  const [[run, number], [otherRun, otherNumber]] = [one, other].map((position) => position?.split("-") ?? []);
  return !run || run !== otherRun || Number(number) > Number(otherNumber);
}

/** @param {Record<string, string | number | undefined>} fields */
const query = (fields) =>
  "?" + new URLSearchParams(Object.entries(fields).flatMap(([name, value]) => (value === undefined ? [] : [[name, `${value}`]])));

/** The whole of a list, page after page. @param {string} path @returns {Promise<any[]>} */
async function everyPage(path) {
  const found = [];
  for (let cursor = ""; cursor !== null; ) {
    const page = await ask(path + query({ limit: 100, cursor }));
    found.push(...page.items);
    cursor = page.next;
  }
  return found;
}

/** @param {string} id */
const orderPath = (id) => `/orders/${encodeURIComponent(id)}`;

/** @returns {Promise<Api.About>} */
export const about = () => ask("/about");

/** @param {{fresh?: boolean}} [request] `fresh`: from the service or not at all
 *  @returns {Promise<Api.Me | null>} the person who is signed in here, or null */
export async function me({ fresh = false } = {}) {
  try {
    return await ask("/me", { cache: fresh ? "no-store" : "default" });
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

/** The corridors and the robots that hold them, as far as this person may see them. @returns {Promise<Api.Traffic>} */
export const traffic = () => ask("/map/traffic");

/** @param {string} from_post @param {string} to_post @returns {Promise<Api.Estimate>} */
export const estimate = (from_post, to_post) => ask("/estimate" + query({ from_post, to_post }));

/** @param {Api.WantedOrder} wanted @param {string} key one per order: repeating it repeats the answer, not the order
 *  @returns {Promise<Api.Order>} */
export const placeOrder = (wanted, key) =>
  ask("/orders", { method: "POST", body: wanted, headers: { "Idempotency-Key": key } });

/** @param {"sent" | "coming" | "all"} role
 *  @param {{limit?: number, cursor?: string, state?: "open" | "attention" | "ended" | "all", search?: string}} [page]
 *  @returns {Promise<Api.Page<Api.Order>>} newest first */
export const orders = (role, page = {}) => ask("/orders" + query({ role, ...page }));

/** @param {string} id @returns {Promise<Api.Order>} */
export const order = (id) => ask(orderPath(id));

/** @param {string} id @returns {Promise<Api.Order>} */
export const cancelOrder = (id) => ask(orderPath(id) + "/cancel", { method: "POST" });

/** Call mail back as its recipient, who cannot come. @param {string} id @returns {Promise<Api.Order>} */
export const sayNotNow = (id) => ask(orderPath(id) + "/not-now", { method: "POST" });

/** Have the robot wait longer. @param {string} id @param {number} extend_s @returns {Promise<Api.Order>} */
export const extendWait = (id, extend_s) => ask(orderPath(id) + "/wait", { method: "POST", body: { extend_s } });

/** Delegates of this person for an order. @param {string} id @returns {Promise<Api.Delegate[]>} */
export const delegates = (id) => everyPage(orderPath(id) + "/delegates");

/** @param {string} id @param {Api.NewDelegate} delegate @returns {Promise<Api.Delegate>} */
export const nameDelegate = (id, delegate) => ask(orderPath(id) + "/delegates", { method: "POST", body: delegate });

/** @param {string} id @param {string} delegate_id */
const delegatePath = (id, delegate_id) => `${orderPath(id)}/delegates/${encodeURIComponent(delegate_id)}`;

/** @param {string} id @param {string} delegate_id @returns {Promise<null>} */
export const revokeDelegate = (id, delegate_id) => ask(delegatePath(id, delegate_id), { method: "DELETE" });

/** Whom I have named, for all my orders that go on. @param {{limit?: number, cursor?: string}} page
 *  @returns {Promise<Api.Page<Api.MyDelegate>>} newest first */
export const myDelegates = (page) => ask("/me/delegates" + query(page));

/** A delegate's code, to be passed on. @param {string} id @param {string} delegate_id @returns {Promise<Api.ShownCode>} */
export const delegateCode = async (id, delegate_id) => withPicture(await ask(delegatePath(id, delegate_id) + "/code"));

/** @param {Api.HandoverCode} code @returns {Api.ShownCode} */
const withPicture = (code) => ({ ...code, picture: code.svg_url });

/** @param {Api.NewStandingOrder} request @returns {Promise<Api.StandingOrder>} */
export const placeStandingOrder = (request) => ask("/standing-orders", { method: "POST", body: request });

/** @param {{limit?: number, cursor?: string}} [page] @returns {Promise<Api.Page<Api.StandingOrder>>} newest first */
export const standingOrders = (page = {}) => ask("/standing-orders" + query(page));

/** @param {string} id @param {"pause" | "resume" | "end"} what @returns {Promise<Api.StandingOrder>} */
export const changeStandingOrder = (id, what) => ask(`/standing-orders/${encodeURIComponent(id)}/${what}`, { method: "POST" });

/** The address of the order's page as a QR code. @param {string} id */
export const pagePicture = (id) => `${BASE}${orderPath(id)}/page.svg`;

/** My code, with the address of its picture. @param {string} id @returns {Promise<Api.ShownCode>} */
export const handoverCode = async (id) => withPicture(await ask(orderPath(id) + "/code"));

/** Ask the robot that waits to hand over: by a tap, or by the digits of a code.
 *  @param {string} id @param {string} [digits] @returns {Promise<unknown>} */
export const handOver = (id, digits = "") => ask(orderPath(id) + "/handover", { method: "POST", body: { digits } });

/** Request a resource by the secret link of a mail. @param {string} what @param {string} token @param {object} [more] */
const askByLink = (what, token, more = {}) => ask("/link/" + what, { method: "POST", body: { token, ...more } });

/** A code that comes with its picture. @param {Api.LinkedCode} code @returns {Api.ShownCode} */
const withPictureInside = ({ svg, ...code }) => ({ ...code, picture: "data:image/svg+xml," + encodeURIComponent(svg) });

/** @param {string} token @returns {Promise<Api.Order>} */
export const linkedOrder = (token) => askByLink("order", token);

/** @param {string} token @returns {Promise<Api.ShownCode>} */
export const linkedCode = async (token) => withPictureInside(await askByLink("code", token));

/** @param {string} token @param {string} [digits] @returns {Promise<unknown>} */
export const linkedHandOver = (token, digits = "") => askByLink("handover", token, { digits });

/** Add a delegate who takes the mail instead. @param {string} token @param {Api.NewDelegate} delegate
 *  @returns {Promise<{delegate: Api.Delegate, code: Api.ShownCode}>} the code is shown this once */
export async function linkedDelegate(token, delegate) {
  const named = await askByLink("delegate", token, delegate);
  return { delegate: named.delegate, code: withPictureInside(named.code) };
}

/** The recipient cannot come: the robot brings it back. @param {string} token @returns {Promise<Api.Order>} */
export const linkedNotNow = (token) => askByLink("not-now", token);

/** @returns {Promise<Api.Robot[]>} */
export const robots = () => everyPage("/robots");

/** @param {{limit?: number, cursor?: string}} [page] @returns {Promise<Api.Inbox>} newest first */
export const notices = (page = { limit: 50 }) => ask("/notices" + query(page));

/** @param {Api.NotificationView["id"][]} ids @returns {Promise<unknown>} */
export const markRead = (ids) => ask("/notices/read", { method: "POST", body: { ids } });

// What dispatchers do.

/** @param {string} path @param {unknown} [body] */
const tell = (path, body) => ask(path, { method: "POST", body });

/** @param {string} name */
const robotPath = (name) => `/robots/${encodeURIComponent(name)}`;

/** It waits at the next post. @param {string} name @param {string} reason @returns {Promise<Api.Command>} */
export const pauseRobot = (name, reason) => tell(robotPath(name) + "/pause", { reason });

/** @param {string} name @returns {Promise<Api.Command>} */
export const resumeRobot = (name) => tell(robotPath(name) + "/resume");

/** It brings back what is aboard and goes home. @param {string} name @param {string} reason @returns {Promise<Api.Command>} */
export const recallRobot = (name, reason) => tell(robotPath(name) + "/recall", { reason });

/** It stands still at once. @param {string} name @param {string} reason @returns {Promise<Api.Command>} */
export const stopRobot = (name, reason) => tell(robotPath(name) + "/emergency-stop", { reason });

/** Its corridor is free again. @param {string} name @param {string} corridor @returns {Promise<Api.Command>} */
export const openWay = (name, corridor) => tell(robotPath(name) + "/open-way", { corridor });

/** Release all corridors that a robot holds. @param {string} name @param {string} reason @returns {Promise<Api.Command>} */
export const takeRobotOut = (name, reason) => tell(robotPath(name) + "/take-out", { reason });

/** @returns {Promise<Api.ClosedCorridors>} */
export const closedCorridors = () => ask("/corridors/closed");

/** No robot is let in any more. @param {string} name @param {string} reason @returns {Promise<Api.ClosedCorridors>} */
export const closeCorridor = (name, reason) => tell(`/corridors/${encodeURIComponent(name)}/close`, { reason });

/** @param {string} name @returns {Promise<Api.ClosedCorridors>} */
export const openCorridor = (name) => tell(`/corridors/${encodeURIComponent(name)}/open`);

/** @param {string} name @returns {Promise<Api.RobotDetails>} */
export const robot = (name) => ask(robotPath(name));

/** Commands to a robot, newest first. @param {string} name @param {{limit?: number}} page @returns {Promise<Api.Page<Api.Command>>} */
export const robotCommands = (name, page) => ask(robotPath(name) + "/commands" + query(page));

/** Alarms of a robot, newest first. @param {string} robot
 *  @param {{limit?: number, cursor?: string, only_open?: "true"}} page @returns {Promise<Api.Page<Api.Alarm>>} */
export const robotAlarms = (robot, page) => ask("/alarms" + query({ robot, ...page }));

/** @param {string} name @param {string} since @returns {Promise<Api.BatteryHistory>} */
export const batteryHistory = (name, since) => ask(robotPath(name) + "/battery" + query({ since }));

/** @returns {Promise<Api.EstimateQuality>} */
export const estimateQuality = () => ask("/estimates");

/** For half a minute it tells what it senses and thinks, as events `insight`. @param {string} name
 *  @param {boolean} anew whether to begin with all that it believes @returns {Promise<Api.Watch>} */
export const watchRobot = (name, anew) => tell(robotPath(name) + "/watch" + query({ anew: `${anew}` }));

/** @param {string} name @returns {Promise<Api.EnrolmentCode>} it is shown this once */
export const makeEnrolmentCode = (name) => tell(robotPath(name) + "/enrolment-codes");

/** @param {string} name @param {{limit?: number}} page @returns {Promise<Api.Page<Api.RobotToken>>} newest first */
export const robotTokens = (name, page) => ask(robotPath(name) + "/tokens" + query(page));

/** @param {string} name @param {string} prefix @returns {Promise<null>} */
export const revokeRobotToken = (name, prefix) => ask(`${robotPath(name)}/tokens/${prefix}`, { method: "DELETE" });

/** Those that are not over, newest first. @returns {Promise<Api.Page<Api.Alarm>>} */
export const openAlarms = () => ask("/alarms" + query({ only_open: "true", limit: 100 }));

/** @param {Api.Alarm["id"]} id @returns {Promise<Api.Alarm>} */
export const acknowledgeAlarm = (id) => tell(`/alarms/${id}/acknowledge`);

/** @param {string} id @param {string} reason @returns {Promise<Api.Order>} */
export const stopForAttention = (id, reason) => tell(orderPath(id) + "/attention", { reason });

/** @param {string} id @param {string} to what becomes of it @param {string} reason "" for none @returns {Promise<Api.Order>} */
export const resolveOrder = (id, to, reason) => tell(orderPath(id) + "/resolve", { to, reason: reason || null });

/** The mail was taken out by hand. @param {string} id @param {string} reason "" for none @returns {Promise<Api.Order>} */
export const holdOrder = (id, reason) => tell(orderPath(id) + "/hold", { reason: reason || null });

/** The mail was taken out for another robot. @param {string} id @param {string} post @param {string} reason "" for none @returns {Promise<Api.Order>} */
export const passOrderOn = (id, post, reason) => tell(orderPath(id) + "/pass-on", { post: post || null, reason: reason || null });

/** @param {string} id @param {string} robot "" for any other @returns {Promise<Api.Order>} */
export const reassignOrder = (id, robot) => tell(orderPath(id) + "/reassign", { robot: robot || null });

/** @param {string} id @param {string} priority @returns {Promise<Api.Order>} */
export const prioritiseOrder = (id, priority) => ask(orderPath(id) + "/priority", { method: "PUT", body: { priority } });

/** @param {string} id @param {number} extend_s @returns {Promise<Api.Order>} */
export const letWait = (id, extend_s) => tell(orderPath(id) + "/wait", { extend_s });

/** Digits may be typed again. @param {string} id @returns {Promise<Api.Order>} */
export const releaseDigits = (id) => tell(orderPath(id) + "/digits/release");

/** Notifications that no channel has taken yet, newest first. @param {{given_up?: "true" | "false", limit?: number, cursor?: string}} page
 *  @returns {Promise<Api.Page<Api.Sending>>} */
export const notSent = (page) => ask("/outbox" + query(page));

/** @param {Api.Sending["id"]} id @returns {Promise<Api.Sending>} */
export const sendAgain = (id) => tell(`/outbox/${id}/retry`);

/** @returns {Promise<{items: Api.SpooledMail[]}>} newest first */
export const spool = () => ask("/spool");

/** @param {string} file @returns {Promise<Api.SpooledText>} */
export const spooledMail = (file) => ask(`/spool/${encodeURIComponent(file)}`);

/** @param {string} search part of a name or address @param {number} limit @returns {Promise<Api.Page<Api.Person>>} */
export const people = (search, limit) => ask("/people" + query({ search, limit }));

/** Everybody's orders of a time as a table. @param {string} from @param {string} to */
export const ordersTable = (from, to) => `${BASE}/orders.csv` + query({ from, to });

/** The marker sheet of a post, in its true size. @param {string} post */
export const markerPicture = (post) => `${BASE}/map/posts/${encodeURIComponent(post)}/marker.svg`;

/** @param {Api.AboutMe} changes @returns {Promise<Api.Person>} */
export const changeMe = (changes) => ask("/me", { method: "PATCH", body: changes });

/** Whom I know: those I exchanged mail with, then those I saved. @param {{search?: string, limit?: number, cursor?: string}} page
 *  @returns {Promise<Api.Page<Api.Contact>>} */
export const contacts = (page) => ask("/me/contacts" + query(page));

/** @param {string} email */
const contactPath = (email) => `/me/contacts/${encodeURIComponent(email)}`;

/** @param {string} email @param {{label: string, post: string | null}} request @returns {Promise<Api.Contact>} */
export const saveContact = (email, request) => ask(contactPath(email), { method: "PUT", body: request });

/** @param {string} email @returns {Promise<null>} */
export const forgetContact = (email) => ask(contactPath(email), { method: "DELETE" });

/** @returns {Promise<Api.NotificationPreferences>} */
export const notificationPreferences = () => ask("/me/notices");

/** @param {Api.NotificationPreferences["muted"]} muted @returns {Promise<Api.NotificationPreferences>} */
export const changeNotificationPreferences = (muted) => ask("/me/notices", { method: "PUT", body: { muted } });

/** Have notifications shown by this browser. @param {PushSubscriptionJSON} subscription @returns {Promise<{id: string}>} */
export const addDevice = ({ endpoint, keys }) => ask("/me/devices", { method: "POST", body: { endpoint, keys } });

/** No more notifications there. @param {string} id @returns {Promise<null>} */
export const removeDevice = (id) => ask(`/me/devices/${encodeURIComponent(id)}`, { method: "DELETE" });

/** @param {string} url @returns {Promise<Api.NewWebhook>} its secret is shown this once */
export const setWebhook = (url) => ask("/me/webhook", { method: "PUT", body: { url } });

/** Something posted there now. @returns {Promise<Api.Trial>} */
export const tryWebhook = () => ask("/me/webhook/trial", { method: "POST" });

/** @returns {Promise<null>} */
export const removeWebhook = () => ask("/me/webhook", { method: "DELETE" });

/** Where I am signed in. @param {{limit?: number, cursor?: string}} [page] @returns {Promise<Api.Page<Api.OpenSession>>} */
export const sessions = (page = { limit: 50 }) => ask("/sessions" + query(page));

/** @param {number} id @returns {Promise<null>} */
export const endSession = (id) => ask(`/sessions/${id}`, { method: "DELETE" });

/** End all sessions but this one. @returns {Promise<null>} */
export const endOtherSessions = () => ask("/sessions", { method: "DELETE" });

/** My scripts' tokens. @param {{limit?: number, cursor?: string}} [page] @returns {Promise<Api.Page<Api.Token>>} */
export const tokens = (page = { limit: 50 }) => ask("/tokens" + query(page));

/** @param {Api.NewToken} request @returns {Promise<Api.MadeToken>} it is shown this once */
export const makeToken = (request) => ask("/tokens", { method: "POST", body: request });

/** @param {string} prefix @returns {Promise<null>} */
export const revokeToken = (prefix) => ask(`/tokens/${prefix}`, { method: "DELETE" });

/** Demonstration only: show the code of this order to the simulated camera. @param {string} order_id */
export const showCodeToCamera = (order_id) => ask("/demo/camera", { method: "POST", body: { order_id } });

/** Open the event stream of this person. @param {string | null} since a place in the stream; null: from now on */
export const openLive = (since) => new EventSource(BASE + "/live" + query({ since: since ?? undefined }));

// What the service worker asks about an address.

const ME = BASE + "/me";
const LIST = BASE + "/orders";
const ORDER = new RegExp(`^${LIST}/[^/]+$`);
const CODE = new RegExp(`^${LIST}/[^/]+/code(\\.svg)?$`);
/** The same for everybody. */
const PUBLIC = [BASE + "/about", BASE + "/map"];
const CONTACTS = ME + "/contacts";
const SESSION = new RegExp(`^${BASE}/sessions?(/|$)`);

/** @param {string} path */
const here = (path) => new URL(path, location.origin);

/** Resources cached before any page asks for them: public ones, and those of the signed-in person. */
export const forEverybody = () => PUBLIC.map(here);
export const aboutMe = () => here(ME);
export const myFirstContacts = () => here(CONTACTS + query({ search: "", limit: 6 }));
export const myRunningOrders = () => ["sent", "coming"].map((role) => here(LIST + query({ role, state: "open", limit: 20 })));

/** True for the few answers that may be kept on the device (docs/decisions/0037). @param {URL} url */
export const isKeptOffline = (url) =>
  isPublic(url) || isMe(url) || url.pathname === CONTACTS || isList(url) || isOrder(url) || CODE.test(url.pathname);

/** @param {URL} url */
export const isPublic = (url) => PUBLIC.includes(url.pathname);

/** @param {URL} url */
export const isMe = (url) => url.pathname === ME;

/** The first page of my own orders. @param {URL} url */
export const isList = (url) => url.pathname === LIST && !url.searchParams.has("cursor") && !url.searchParams.get("search");

/** A marker that a list of orders was fetched: lists are answered from the cached orders. */
export const anyList = () => here(LIST);

/** @param {URL} url */
export const isOrder = (url) => ORDER.test(url.pathname);

/** @param {string} id */
export const aboutOrder = (id) => here(BASE + orderPath(id));

/** @param {string} id */
export function aboutCode(id) {
  const code = aboutOrder(id) + "/code";
  return { code: new URL(code), picture: new URL(code + ".svg") };
}

/** True for requests after which another person may be signed in. @param {string} method @param {URL} url */
export const changesSession = (method, url) =>
  (method !== "GET" && SESSION.test(url.pathname)) || url.pathname.startsWith(BASE + "/sign-in");
