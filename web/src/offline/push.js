/**
 * Notifications that this device shows by itself (Web Push). The settings page asks `pushState` and switches it on and off.
 * @typedef {"unsupported" | "refused" | "off" | "on"} PushState
 */
import * as api from "../service/api.js";
import { PUSH_DEVICE } from "../session/session.js";
import { t } from "../texts/texts.js";


const isSupported = () => "serviceWorker" in navigator && "PushManager" in window && "Notification" in window;

/** @returns {{id: string, endpoint: string, person_id: string} | null} */
const device = () => JSON.parse(localStorage.getItem(PUSH_DEVICE) ?? "null");

/** The text for a state and its remedy. @param {PushState} state */
export const pushWords = (state) => t(`push.${state}`);

/** @returns {Promise<PushState>} */
export async function pushState() {
  if (!isSupported()) return "unsupported";
  if (Notification.permission === "denied") return "refused";
  return device() && (await subscription()) ? "on" : "off";
}

/** Ask the person, subscribe, tell the service. To be called by a tap. @param {string} person_id @returns {Promise<PushState>} */
export async function startPush(person_id) {
  if (!isSupported()) return "unsupported";
  const allowed = await Notification.requestPermission();
  if (allowed !== "granted") return allowed === "denied" ? "refused" : "off";
  await tellService(person_id, await subscribed());
  return "on";
}

/** This device shows nothing any more, and the service sends it nothing. @returns {Promise<PushState>} */
export async function endPush() {
  const known = device();
  localStorage.removeItem(PUSH_DEVICE);
  await (await subscription())?.unsubscribe();
  if (known) await api.removeDevice(known.id).catch(unlessGone);
  return pushState();
}

/** On each visit: report a renewed subscription; end that of another person. @param {string} person_id */
export async function checkPush(person_id) {
  const known = device();
  if (!known) return;
  if (known.person_id !== person_id) return void (await endPush().catch(() => undefined));
  const now = Notification.permission === "granted" ? await subscribed() : null;
  if (now && now.endpoint !== known.endpoint) await tellService(person_id, now);
}

/** @param {string} person_id @param {PushSubscription} made */
async function tellService(person_id, made) {
  const { id } = await api.addDevice(made.toJSON());
  localStorage.setItem(PUSH_DEVICE, JSON.stringify({ id, endpoint: made.endpoint, person_id }));
}

async function subscribed() {
  const before = await subscription();
  if (before) return before;
  const { push_key } = await api.notificationPreferences();
  const { pushManager } = await navigator.serviceWorker.ready;
  return pushManager.subscribe({ userVisibleOnly: true, applicationServerKey: push_key });
}

async function subscription() {
  const registration = isSupported() ? await navigator.serviceWorker.getRegistration() : undefined;
  return (await registration?.pushManager.getSubscription()) ?? null;
}

/** Another's device, or one that the service has forgotten. @param {unknown} failure */
function unlessGone(failure) {
  if (!(failure instanceof api.ApiProblem && failure.status === 404)) throw failure;
}
