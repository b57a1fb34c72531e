/** A mail address breaks after its signs, and within a word only where nothing else fits. */
import { html } from "lit";

/** @param {string} email */
export const inParts = (email) => email.split(/(?<=[@._+-])/).map((part, i) => (i ? html`<wbr />${part}` : part));

/** @param {string} email @param {string} [more] what is said behind it */
export const address = (email, more = "") => html`<span class="address">${inParts(email)}${more}</span>`;
