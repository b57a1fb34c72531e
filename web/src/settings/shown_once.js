/** A secret that is shown now and never again, to be copied. */
import { html } from "lit";
import { t } from "../texts/texts.js";

/** @param {string} id @param {string} label @param {string} secret */
export const shownOnce = (id, label, secret) => html`<div class="once" role="group" aria-labelledby="${id}-label">
  <p id="${id}-label"><strong>${label}</strong> <span class="remark">${t("settings.once")}</span></p>
  <div class="copy">
    <code>${secret}</code>
    <button type="button" class="quiet" @click=${() => navigator.clipboard?.writeText(secret)}>${t("settings.copy")}</button>
  </div>
</div>`;
