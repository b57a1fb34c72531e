import { html } from "lit";
import "../robots/robot_page.js";
import "../robots/robots_page.js";
import { openPage } from "./open_page.js";

const robot = new URLSearchParams(location.search).get("robot");
await openPage("robots", ({ person }) =>
  robot ? html`<robot-page .robot=${robot} .person=${person}></robot-page>` : html`<robots-page></robots-page>`,
);
