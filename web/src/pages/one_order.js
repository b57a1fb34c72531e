import { html } from "lit";
import { openPageForGuest } from "./open_page.js";

addEventListener("keydown", () => import("../elements/keeps_keyboard.js").then(({ keepKeyboard }) => keepKeyboard()), { once: true });
// The token stands behind the #, which no browser sends anywhere.
await openPageForGuest("title.one_order", () => html`<one-order .token=${location.hash.slice(1)}></one-order>`);
