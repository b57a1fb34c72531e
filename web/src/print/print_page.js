/** Pages to print: the slip that goes with the mail of one order, or the marker sheets of the map's posts. */
import { html } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import * as api from "../service/api.js";
import { followPage, PAGES } from "../service/links.js";
import { baysOf } from "../map/map_bays.js";
import { OnLive } from "../live/live.js";
import { loadMap } from "../service/posts.js";
import { inWords } from "../service/problems.js";
import { personHere } from "../session/session.js";
import { counted, t } from "../texts/texts.js";
import { problemLine } from "../elements/field.js";
import { icon } from "../elements/icon.js";
import { orderSlip } from "./order_slip.js";
import { PageElement } from "../elements/page_element.js";
/** @import { CampusMap, MapPost, Order, ShownCode } from "../../types/api_types.ts" */

const TURNED_BACK = ["returning", "at_return"];

export class PrintPage extends PageElement {
  static properties = {
    order_id: { attribute: false },
    map: { state: true },
    order: { state: true },
    code: { state: true },
    chosen: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {string | null} whose slip is printed; null for marker sheets */
    this.order_id = null;
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {Order | null} */
    this.order = null;
    /** @type {ShownCode | null} */
    this.code = null;
    /** @type {Set<string>} posts whose sheets are printed */
    this.chosen = new Set();
    this.problem = "";
    new OnLive(this, {
      order: (order) => order.id === this.order_id && this.#poll(),
      resync: () => this.#poll(),
    });
  }

  firstUpdated() {
    this.#fetch();
  }

  render() {
    const { map } = this;
    if (!map) return this.problem ? this.#notHere() : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    return this.order_id === null ? this.#markers(map) : this.#slip(map);
  }

  #notHere() {
    return html`<h1>${t("title.print")}</h1>${problemLine(this.problem)}`;
  }

  /** @param {CampusMap} map */
  #slip(map) {
    if (!this.order) return this.#notHere();
    return html`<div class="before-print">
        <h1>${t("print.slip")}</h1>
        <p class="lead" role="status">${t(`print.slip.${this.code ? "with_code" : this.#isAwaited(this.order) ? "waits" : "without_code"}`)}</p>
        ${this.#buttons()}
      </div>
      ${orderSlip(this.order, map, this.code, new URL(followPage(this.order.id), location.href).href)}`;
  }

  /** True if its code is to be shown here once there is one. @param {Order} order */
  #isAwaited({ state, placed_by }) {
    return state === "queued" && placed_by !== null && placed_by.email === personHere()?.email;
  }

  /** @param {CampusMap} map */
  #markers(map) {
    const sheets = map.posts.filter(({ name }) => this.chosen.has(name)).flatMap(sheetsOf);
    return html`<div class="before-print">
        <h1>${t("print.markers")}</h1>
        <p class="lead">${t("print.markers.hint")}</p>
        <fieldset class="options posts">
          <legend>${t(map.posts.some((post) => baysOf(post).length) ? "print.posts.bays" : "print.posts")}</legend>
          ${map.posts.map(
            (post) => html`<label>
              <input type="checkbox" name="post" value=${post.name} .checked=${this.chosen.has(post.name)} @change=${() => this.#choose(post.name)} />
              <span>${post.title}<small>${counted("print.sheets", sheetsOf(post).length)}</small></span>
            </label>`,
          )}
        </fieldset>
        ${this.#buttons(sheets.length)}
      </div>
      <div class="sheets">
        ${repeat(sheets, (post, i) => `${post.name}-${i}`, ({ name, title }) => html`<img class="marker-sheet" src=${api.markerPicture(name)} alt=${t("print.marker_of", { post: title })} />`)}
      </div>`;
  }

  /** @param {number} [sheets] */
  #buttons(sheets) {
    return html`<div class="choices">
      <button type="button" class="main" ?disabled=${sheets === 0} @click=${() => print()}>
        ${sheets === undefined ? t("print.now") : counted("print.now_sheets", sheets)}
      </button>
      <a class="button quiet" href=${PAGES.mailroom}>${icon("tray")}${t("print.back")}</a>
    </div>`;
  }

  /** @param {string} post */
  #choose(post) {
    const chosen = new Set(this.chosen);
    if (!chosen.delete(post)) chosen.add(post);
    this.chosen = chosen;
  }

  /** A slip that is not printed yet gets its code as soon as there is one. Asked for: what all dispatchers hear of has no code. */
  async #poll() {
    if (!this.order) return;
    try {
      this.order = await api.order(this.order.id);
      await this.#fetchCode(this.order);
    } catch {
      // What is known stays.
    }
  }

  /** @param {Order | null} order */
  async #fetchCode(order) {
    this.code = order && (order.my_code || TURNED_BACK.includes(order.state)) ? await theirCode(order.id) : null;
  }

  async #fetch() {
    try {
      const [map, order] = await Promise.all([loadMap(), this.order_id === null ? null : api.order(this.order_id)]);
      [this.map, this.order] = [map, order];
      this.chosen = new Set(map.posts.map(({ name }) => name));
      await this.#fetchCode(order);
    } catch (failure) {
      this.problem = failure instanceof api.ApiProblem && failure.status === 404 ? t("follow.unknown.body") : inWords(failure);
      this.map ??= await loadMap().catch(() => null);
    }
  }
}

/** The sheets of a post, and those of its bays. @param {MapPost} post */
const sheetsOf = (post) =>
  [
    post,
    ...baysOf(post).map((bay, i) => ({ ...bay, title: t("print.bay", { post: post.title, number: i + 1 }) })),
  ].flatMap((place) => Array(place.markers).fill(place));

/** The mailroom may take back what comes back; whether it is its turn, the service says. @param {string} order_id */
async function theirCode(order_id) {
  try {
    return await api.handoverCode(order_id);
  } catch (failure) {
    if (failure instanceof api.ApiProblem && failure.status === 404) return null;
    throw failure;
  }
}

customElements.define("print-page", PrintPage);
