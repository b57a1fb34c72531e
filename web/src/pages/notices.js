import { html } from "lit";
import { openPage } from "./open_page.js";

await openPage("notices", () => html`<notifications-page></notifications-page>`);
