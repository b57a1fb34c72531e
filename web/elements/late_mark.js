/** What marks an order that is later than was promised: a word and a drawing, not a colour alone. */
import { html } from "lit";
import { t } from "../texts.js";
import { icon } from "./icon.js";

export const lateMark = () => html`<span class="late">${icon("clock")}${t("late.mark")}</span>`;
