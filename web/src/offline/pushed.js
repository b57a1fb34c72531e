/** Notifications that the service pushes: shown, counted on the app's icon, and opened with a tap. */
import * as api from "../service/api.js";
import { pageOf, PAGES } from "../service/links.js";
import { keepOrder } from "./kept_answers.js";
/** @import { NotificationView } from "../../types/api_types.ts" */
/** @typedef {Pick<NotificationView, "kind" | "order_id" | "title" | "body" | "at"> & {tag: string, language: string}} Pushed what app/notifications sends */

const NAME = "Campus Mail";
/** Kinds that stay on screen: a person stands before a robot, or soon will. */
const STAYS = ["robot_here", "robot_here_for_you", "at_return", "alarm"];

/** Browsers insist that every push is shown, even one that cannot be read. @param {WorkerScope} worker @param {{text(): string} | null} data */
export async function show({ registration }, data) {
  const notice = understood(data);
  await Promise.all([
    registration.showNotification(notice.title ?? NAME, {
      body: notice.body,
      tag: notice.tag,
      lang: notice.language,
      icon: "/icons/icon-192.png",
      badge: "/icons/badge-96.png",
      requireInteraction: STAYS.includes(notice.kind ?? ""),
      data: { url: (notice.kind && pageOf(/** @type {NotificationView} */ (notice))) ?? PAGES.notices, kind: notice.kind, at: notice.at },
    }),
    count().catch(() => undefined),
    notice.order_id ? keepOrder(notice.order_id).catch(() => undefined) : undefined,
  ]);
}

/** @param {{text(): string} | null} data @returns {Partial<Pushed>} */
function understood(data) {
  try {
    const said = JSON.parse(data?.text() ?? "");
    return typeof said?.title === "string" ? said : {};
  } catch {
    return {};
  }
}

async function count() {
  const { unread } = await api.notices({ limit: 1 });
  await navigator.setAppBadge?.(unread);
}

/** Open the page of a notification and mark it as read. @param {WorkerScope} worker @param {Notification} notification */
export async function open({ clients }, notification) {
  notification.close();
  await Promise.all([lead(clients, notification.data?.url), read(notification.data).catch(() => undefined)]);
}

/** To the page that shows it already, or to a new one: no other page in use is navigated away.
 * @param {WorkerScope["clients"]} clients @param {string | undefined} address */
async function lead(clients, address) {
  const url = new URL(address ?? PAGES.notices, location.origin).href;
  const pages = await clients.matchAll({ type: "window" });
  const there = pages.find((page) => page.url.split("#")[0] === url);
  return there ? there.focus() : clients.openWindow(url);
}

/** Of the inbox too. @param {Partial<Pushed> | null} told */
async function read(told) {
  const at = Date.parse(told?.at ?? "");
  const { items } = await api.notices();
  const ids = items.filter((one) => !one.read && one.kind === told?.kind && Date.parse(one.at) === at).map(({ id }) => id);
  if (ids.length) await api.markRead(ids);
  await count();
}

/** The push service gave this browser another address. @param {WorkerScope} worker */
export async function renewSubscription({ registration }) {
  const { push_key } = await api.notificationPreferences();
  const made = await registration.pushManager.subscribe({ userVisibleOnly: true, applicationServerKey: push_key });
  await api.addDevice(made.toJSON());
}
