/** The page shown to a person without the required role: who may open it, and a way on. */
import { html } from "lit";
import { PAGES } from "../service/links.js";
import { t } from "../texts/texts.js";
import { icon } from "../elements/icon.js";
import { PageElement } from "../elements/page_element.js";
/** @import { PageName } from "../service/links.js" */

export class NoRole extends PageElement {
  static properties = { page: {} };

  constructor() {
    super();
    /** @type {PageName} one that `mayOpen` refuses */
    this.page = "mailroom";
  }

  render() {
    return html`<section class="blank">
      <h1>${t("nav.no_role.title")}</h1>
      <p>${t(`nav.no_role.${this.page}`)}</p>
      <a class="button" href=${PAGES.order}>${icon("send")}${t("nav.no_role.back")}</a>
    </section>`;
  }
}

customElements.define("no-role", NoRole);
