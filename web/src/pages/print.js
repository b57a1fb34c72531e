import { html } from "lit";
import "../print/print_page.js";
import { orderFrom } from "../service/links.js";
import { openPage } from "./open_page.js";

await openPage("print", () => html`<print-page .order_id=${orderFrom(location.search)}></print-page>`);
