/** The base of all our elements: they draw into the page itself, so that labels, styles and zoom work as in any page. */
import { LitElement } from "lit";

export class PageElement extends LitElement {
  createRenderRoot() {
    return this;
  }

  /** Put the keyboard where the eyes are, once what is there now has been drawn. @param {string} selector */
  async focusOn(selector) {
    await this.updateComplete;
    const found = this.querySelector(selector);
    if (found instanceof HTMLElement || found instanceof SVGElement) found.focus();
  }
}
