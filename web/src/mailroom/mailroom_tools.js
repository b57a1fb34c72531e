/** Tools of the mailroom that are used now and then. Each part is fetched when it is first wanted. */
import { html } from "lit";
import { fetched } from "../service/fetched_again.js";
import { PRINT_PAGE, WALL_PAGE } from "../service/links.js";
import { t } from "../texts/texts.js";
import { icon } from "../elements/icon.js";

const PARTS = {
  "walk-up-order": () => fetched(() => import("./walk_up_order.js"), import.meta.resolve("./walk_up_order.js")),
  "unsent-mail": () => fetched(() => import("./unsent_mail.js"), import.meta.resolve("./unsent_mail.js")),
  "export-orders": () => fetched(() => import("./export_orders.js"), import.meta.resolve("./export_orders.js")),
};

export const mailroomTools = () => html`<div class="tools">
    <button type="button" class="primary" @click=${() => open("walk-up-order")}>${icon("letter")}${t("mailroom.walk_up")}</button>
    <button type="button" @click=${() => open("unsent-mail")}>${t("mailroom.unsent")}</button>
    <button type="button" @click=${() => open("export-orders")}>${t("mailroom.export")}</button>
    <a class="button" href=${PRINT_PAGE}>${t("mailroom.print")}</a>
    <a class="button" href=${WALL_PAGE}>${t("mailroom.wall")}</a>
  </div>`;

/** The dialogs that they open, empty until then. */
export const mailroomDialogs = () => html`<div><walk-up-order></walk-up-order><unsent-mail></unsent-mail><export-orders></export-orders></div>`;

/** @param {keyof typeof PARTS} name */
async function open(name) {
  await PARTS[name]();
  const part = /** @type {HTMLElement & {open(): Promise<void>}} */ (document.querySelector(name));
  await part.open();
}
