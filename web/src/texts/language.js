/** Another language for the page that is shown: what is on it is drawn anew, where it stands. */
import { LitElement } from "lit";
import { loadTexts } from "./texts.js";

/** @param {string} language */
export async function speak(language) {
  await loadTexts(language);
  for (const element of document.querySelectorAll("*")) if (element instanceof LitElement) element.requestUpdate();
}
