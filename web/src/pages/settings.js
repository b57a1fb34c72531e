import { html } from "lit";
import { openPage } from "./open_page.js";

await openPage("settings", ({ person }) => html`<settings-page .person=${person}></settings-page>`);
