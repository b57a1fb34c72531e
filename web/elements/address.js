/** A mail address that breaks after its @ and its dots, and within a word only where nothing else fits. */
import { html } from "lit";

/** @param {string} email */
export const address = (email) =>
  html`<span class="address">${email.split(/(?<=[@.])/).map((part, i) => (i ? html`<wbr />${part}` : part))}</span>`;
