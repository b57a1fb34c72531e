import { html } from "lit";
import "../elements/mailroom_page.js";
import "../elements/mailroom_wall.js";
import { openPage } from "../open_page.js";

const wall = new URLSearchParams(location.search).has("wall");
await openPage("mailroom", () => (wall ? html`<mailroom-wall></mailroom-wall>` : html`<mailroom-page></mailroom-page>`));
