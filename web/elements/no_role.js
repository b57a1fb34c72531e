/** What stands on a page that is for others: who opens it, and a way on. */
import { html } from "lit";
import { PAGES } from "../links.js";
import { t } from "../texts.js";
import { icon } from "./icon.js";
/** @import { PageName } from "../links.js" */

/** @param {PageName} page one that `mayOpen` refuses */
export const noRole = (page) => html`<section class="blank">
  <h1>${t("nav.no_role.title")}</h1>
  <p>${t(`nav.no_role.${page}`)}</p>
  <a class="button" href=${PAGES.order}>${icon("send")}${t("nav.no_role.back")}</a>
</section>`;
