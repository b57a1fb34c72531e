import { html } from "lit";
import "../elements/order_page.js";
import { openPage } from "../open_page.js";

await openPage("order", () => html`<order-page></order-page>`);
