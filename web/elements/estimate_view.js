/** When it would arrive, said before anything is ordered, with how much that is worth. */
import { html, nothing } from "lit";
import { t } from "../texts.js";
import { length, windowText } from "../times.js";
import { icon } from "./icon.js";
/** @import { Estimate } from "../api_types.ts" */

/** @param {Estimate | "looking" | null} estimate if it were fetched now @param {number} later_ms by how much it is fetched later */
export const estimateView = (estimate, later_ms = 0) => html`<div class="estimate" role="status">
  ${icon("clock")}
  <div>
    ${estimate === null ? html`<span class="hint">${t("estimate.wait")}</span>` : nothing}
    ${estimate === "looking" ? html`<span class="hint">${t("estimate.looking")}</span>` : nothing}
    ${estimate !== null && estimate !== "looking" ? known(estimate, later_ms) : nothing}
  </div>
</div>`;

/** @param {Estimate} estimate @param {number} later_ms */
const known = ({ window, length_m, assumed }, later_ms) =>
  html`<span class="of">${t("estimate.title")}</span> <strong>${windowText(later(window, later_ms))}</strong>
    <span class="hint">${t(assumed ? "estimate.assumed" : "estimate.based", { length: length(length_m) })}</span>`;

/** @param {{from: string, to: string}} window @param {number} by_ms */
const later = ({ from, to }, by_ms) => ({ from: moved(from, by_ms), to: moved(to, by_ms) });

/** @param {string} at @param {number} by_ms */
const moved = (at, by_ms) => new Date(Date.parse(at) + by_ms).toISOString();
