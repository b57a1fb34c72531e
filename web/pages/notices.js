import { html } from "lit";
import "../elements/notices_page.js";
import { openPage } from "../open_page.js";

await openPage("notices", () => html`<notices-page></notices-page>`);
