/** A question that people have at this very place, with its answer folded away. */
import { html } from "lit";
import { t } from "../texts.js";

/** @param {"window" | "code" | "meeting"} about */
export const helpWords = (about) => html`<details class="helping">
  <summary>${t(`help.${about}.question`)}</summary>
  <p>${t(`help.${about}.answer`)}</p>
</details>`;
