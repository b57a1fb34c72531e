/** Low-priority work after a page has opened: orders that wait on this device, the worker. */
import { OnLive } from "../live/live.js";
import { onKept } from "../session/session.js";
import { tellWorker, workOffline } from "../offline/with_worker.js";
/** @import { Person } from "../../types/api_types.ts" */
/** @import { PageShell } from "../elements/page_shell.js" */

/** @param {PageShell} shell @param {Person | null} person */
export async function afterOpening(shell, person) {
  if (person) onKept(() => showFirstKept(shell, person));
  if (person) new OnLive(shell, { order: (order) => tellWorker({ order, person_id: person.id }) });
  addEventListener("keydown", () => import("../elements/keeps_keyboard.js").then(({ keepKeyboard }) => keepKeyboard()), { once: true });
  await workOffline(person);
}

/** Its element sees to all others. @param {PageShell} shell @param {Person} person */
async function showFirstKept(shell, person) {
  if (shell.kept.length) return;
  const [{ keptOrders }] = await Promise.all([import("../offline/outbox.js"), import("../offline/kept_orders.js")]);
  shell.keptJustNow = true;
  shell.kept = await keptOrders(person.id);
}
