/** To the parts of a long page, always at hand on a phone; on a desk all of them are seen at once. */
import { html } from "lit";
import { t } from "../texts/texts.js";

/** @typedef {{id: string, label: string, count?: number, wrong?: boolean}} Section `id`: of its heading, which takes the keyboard */

/** @param {Section[]} sections */
export const sectionLinks = (sections) => html`<nav class="sections" aria-label=${t("app.sections")}>${sections.map(
  ({ id, label, count, wrong }) => html`<a href="#${id}" class=${wrong ? "wrong-here" : ""}>${label}${count ? html` <span class="count">${count}</span>` : ""}</a>`,
)}</nav>`;
