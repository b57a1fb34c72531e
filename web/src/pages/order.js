import { html } from "lit";
import { openPage } from "./open_page.js";

await openPage("order", () => html`<order-page></order-page>`);
