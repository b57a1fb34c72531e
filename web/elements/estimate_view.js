/** When it would arrive, said before anything is ordered, with how much that is worth. */
import { html, nothing } from "lit";
import { t } from "../texts.js";
import { length, windowText } from "../times.js";
import { icon } from "./icon.js";
/** @import { Estimate } from "../api_types.ts" */

/** @param {Estimate | "looking" | null} estimate */
export const estimateView = (estimate) => html`<div class="estimate" role="status">
  ${icon("clock")}
  <div>
    ${estimate === null ? html`<span class="hint">${t("estimate.wait")}</span>` : nothing}
    ${estimate === "looking" ? html`<span class="hint">${t("estimate.looking")}</span>` : nothing}
    ${estimate !== null && estimate !== "looking" ? known(estimate) : nothing}
  </div>
</div>`;

/** @param {Estimate} estimate */
const known = ({ window, length_m, assumed }) =>
  html`<span class="of">${t("estimate.title")}</span> <strong>${windowText(window)}</strong>
    <span class="hint">${t(assumed ? "estimate.assumed" : "estimate.based", { length: length(length_m) })}</span>`;
