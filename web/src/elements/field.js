/** A labelled field with its hint and its problem, wired together for screen readers; what is said beside fields. */
import { html, nothing } from "lit";
import { t } from "../texts/texts.js";
import { icon } from "./icon.js";

/**
 * @typedef {{name: string, label: string, hint?: string, problem?: string, optional?: boolean}} FieldFrame
 * @param {FieldFrame} frame
 * @param {(attributes: {id: string, describedBy: string | typeof nothing, invalid: "true" | typeof nothing}) => unknown} control
 *   draws the input itself with these attributes
 */
export function field({ name, label, hint, problem, optional }, control) {
  const id = `field-${name}`;
  const notes = [problem && `${id}-problem`, hint && `${id}-hint`].filter(Boolean).join(" ");
  return html`
    <div class="field">
      <label for=${id}>${label}${optional ? html` <span class="optional">(${t("order.optional")})</span>` : nothing}</label>
      ${control({ id, describedBy: notes || nothing, invalid: problem ? "true" : nothing })}
      ${problem ? problemLine(problem, `${id}-problem`) : nothing}
      ${hint ? html`<p class="hint" id="${id}-hint">${hint}</p>` : nothing}
    </div>
  `;
}

/** @param {string} text @param {string} [id] */
export const problemLine = (text, id) =>
  html`<p class="problem" role="alert" id=${id ?? nothing}>${icon("warning")}<span>${text}</span></p>`;

/** A question that people have at this very place, with its answer folded away. @param {"window" | "code" | "meeting"} about */
export const helpWords = (about) => html`<details class="helping">
  <summary>${t(`help.${about}.question`)}</summary>
  <p>${t(`help.${about}.answer`)}</p>
</details>`;
