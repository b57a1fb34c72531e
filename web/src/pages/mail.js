import { html } from "lit";
import { openPage } from "./open_page.js";

await openPage("mail", () => html`<mail-page></mail-page>`);
