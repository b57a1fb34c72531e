/** A part of a page that is fetched and drawn only once it is opened. */
import { html, nothing } from "lit";
import { icon } from "./icon.js";
import { PageElement } from "./page_element.js";

export class OpensLater extends PageElement {
  static properties = { label: { attribute: false }, drawing: { attribute: false }, load: { attribute: false }, content: { attribute: false }, loaded: { state: true } };

  constructor() {
    super();
    this.label = "";
    /** @type {Parameters<typeof icon>[0]} */
    this.drawing = "person";
    /** @type {() => Promise<unknown>} the modules that the content needs */
    this.load = async () => undefined;
    /** @type {() => unknown} */
    this.content = () => nothing;
    this.loaded = false;
  }

  render() {
    return html`<details class="card later" @toggle=${this.#open}>
      <summary>${icon(this.drawing)}${this.label}</summary>
      <div class="within">${this.loaded ? this.content() : nothing}</div>
    </details>`;
  }

  async #open() {
    if (this.loaded) return;
    await this.load();
    this.loaded = true;
  }
}

customElements.define("opens-later", OpensLater);
