import { html } from "lit";
import "../elements/mail_page.js";
import { openPage } from "../open_page.js";

await openPage("mail", () => html`<mail-page></mail-page>`);
