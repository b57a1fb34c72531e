/**
 * The campus as lines and posts, and the robots where they were *seen*: never where they might be by now. What is
 * expected is drawn as expected. The same facts stand below it as a list.
 */
import { html, nothing, svg } from "lit";
import { drawing, inLines, placeLabels } from "../map_drawing.js";
import { shortestWay } from "../posts.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { Ticking } from "../ticking.js";
import { ago, windowText } from "../times.js";
import { PageElement } from "./page_element.js";
import { robotFacts } from "./robot_facts.js";
/** @import { CampusMap, Robot } from "../api_types.ts" */
/** @import { Label } from "../map_drawing.js" */

export class CampusMapElement extends PageElement {
  static properties = {
    map: { attribute: false },
    from: {},
    to: {},
    robot: { attribute: false },
    following: { type: Boolean },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    this.from = "";
    this.to = "";
    /** @type {Robot | null} the robot to show; null for none */
    this.robot = null;
    /** Whether what is known of the robot stands below it. */
    this.following = false;
    new Ticking(this);
  }

  render() {
    if (!this.map) return nothing;
    const drawn = drawing(this.map);
    const { labels, view } = placeLabels(drawn, this.#wordings(this.map));
    const words = t("map.title", { title: this.map.title });
    return html`<figure class="campus">
      <svg viewBox="${view.x} ${view.y} ${view.width} ${view.height}" role="img" aria-label=${words}>
        ${drawn.corridors.map(({ points }) => svg`<path class="corridor" d=${pathOf(points)} />`)}
        ${this.#wayPaths(drawn, this.#way(this.map), "way")}
        ${this.#wayPaths(drawn, this.#ahead(this.map), "ahead")}
        ${drawn.posts.map((post) => this.#post(post))}
        ${drawn.posts.map((post) => this.#label(labels.get(post.name)))}
      </svg>
      ${this.following ? this.#caption(this.map) : nothing}
    </figure>`;
  }

  /** @param {CampusMap} map */
  #caption(map) {
    return html`<figcaption>
      <p class="hint">${t("map.legend.honest")} ${map.corridors.some(({ assumed }) => assumed) ? t("map.assumed") : nothing}</p>
      <h3>${t("map.facts")}</h3>
      ${robotFacts(map, this.robot, this.from, this.to)}
    </figcaption>`;
  }

  /** Posts that matter most choose their side first. @param {CampusMap} map */
  #wordings(map) {
    const facts = [this.robot?.last_seen?.post, this.robot?.expected?.post, this.from, this.to];
    return map.posts
      .map(({ name, title }) => ({ name, lines: [...inLines(title), ...this.#notes(name)] }))
      .sort((a, b) => Number(facts.includes(b.name)) - Number(facts.includes(a.name)));
  }

  /** @param {string} post */
  #notes(post) {
    const { last_seen, expected } = this.robot ?? {};
    return [
      ...(last_seen?.post === post ? [t("map.seen_here"), ago(last_seen.at, serverNow())] : []),
      ...(expected?.post === post ? [t("map.expected_here"), windowText(expected)] : []),
    ];
  }

  /** @param {CampusMap} map */
  #way(map) {
    return this.from && this.to && this.from !== this.to ? shortestWay(map, this.from, this.to) : [];
  }

  /** Where the robot must be by now: somewhere between the post that saw it and the one that expects it. @param {CampusMap} map */
  #ahead(map) {
    const seen = this.robot?.last_seen?.post;
    const next = this.robot?.expected?.post ?? this.robot?.towards;
    return seen && next && seen !== next ? shortestWay(map, seen, next) : [];
  }

  /** @param {ReturnType<typeof drawing>} drawn @param {string[]} posts @param {string} kind */
  #wayPaths(drawn, posts, kind) {
    return posts.slice(1).map((there, i) => {
      const corridor = drawn.corridors.find(({ a, b }) => (a === posts[i] && b === there) || (b === posts[i] && a === there));
      if (!corridor) return nothing;
      const points = corridor.a === posts[i] ? corridor.points : [...corridor.points].reverse();
      return svg`<path class=${kind} d=${pathOf(points)} />`;
    });
  }

  /** @param {{name: string, x: number, y: number, dock: unknown}} post */
  #post({ name, x, y, dock }) {
    const end = name === this.from || name === this.to;
    return svg`<g transform="translate(${x} ${y})">
      ${dock ? svg`<rect class="dock" x="-9" y="-9" width="18" height="18" rx="5" />` : nothing}
      <circle class=${end ? "post end" : "post"} r=${end ? 7 : 5.5} />
      ${name === this.to ? svg`<circle class="goal" r="3" />` : nothing}
      ${this.robot?.expected?.post === name ? svg`<circle class="expected" r="12" />` : nothing}
      ${this.robot?.last_seen?.post === name ? seenRobot() : nothing}
    </g>`;
  }

  /** @param {Label | undefined} label */
  #label(label) {
    if (!label) return nothing;
    const titles = label.lines.length - label.lines.filter((line) => this.#isNote(line)).length;
    return svg`<text class="label" x=${label.x} y=${label.y} text-anchor=${label.anchor}>${label.lines.map(
      (line, i) => svg`<tspan class=${i < titles ? "name" : "note"} x=${label.x} dy=${i ? 15 : 0}>${line}</tspan>`,
    )}</text>`;
  }

  /** @param {string} line */
  #isNote(line) {
    const posts = [this.robot?.last_seen?.post, this.robot?.expected?.post];
    return posts.some((post) => post && this.#notes(post).includes(line));
  }
}

const seenRobot = () => svg`<circle class="aura" r="17" />
  <g class="robot"><circle r="11" /><path d="M-5 -2.500a3 3 0 0 1 3-3h4a3 3 0 0 1 3 3v5a3 3 0 0 1-3 3h-4a3 3 0 0 1-3-3zM-1.8 -.5v1M1.8 -.5v1M0 -5.500v-2" /></g>`;

/** @param {{x: number, y: number}[]} points */
const pathOf = (points) => "M" + points.map(({ x, y }) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L");

customElements.define("campus-map", CampusMapElement);
