import { html } from "lit";
import { openPage } from "./open_page.js";
import { withStyles } from "../elements/styles_later.js";

const wall = new URLSearchParams(location.search).has("wall");
document.documentElement.classList.toggle("wall", wall);
if (wall) await Promise.all([withStyles("/src/styles/wall.css"), import("../mailroom/mailroom_wall.js")]);
await openPage("mailroom", () => (wall ? html`<mailroom-wall></mailroom-wall>` : html`<mailroom-page></mailroom-page>`));
