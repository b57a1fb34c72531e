/** When the letter arrives: an interval, never a countdown. */
import { html, nothing } from "lit";
import { titleOf } from "../posts.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { windowText } from "../times.js";
/** @import { CampusMap, Order } from "../api_types.ts" */

/** @param {Order} order @param {CampusMap} map */
export function arrivalWindow({ window, to_post }, map) {
  if (!window) return html`<p class="window">${t("window.none")}</p>`;
  const late = Date.parse(window.to) < serverNow();
  return html`<p class="window">
    <span class="of">${t("window.label", { post: titleOf(map, to_post) })}</span>
    <strong>${windowText(window, serverNow())}</strong>
    ${late ? html`<span class="remark">${t("window.past")}</span>` : nothing}
    ${window.assumed ? html`<span class="remark">${t("window.assumed")}</span>` : nothing}
  </p>`;
}
