import { html } from "lit";
import { orderFrom } from "../service/links.js";
import { openPage } from "./open_page.js";

await openPage("follow", ({ about }) => html`<follow-page .order_id=${orderFrom(location.search)} .demo=${about.demo}></follow-page>`);
