/**
 * The campus as lines and posts, and the robots where they were *seen*: never where they might be by now. What is
 * expected is drawn as expected. The same facts stand below it as a list.
 */
import { html, nothing } from "lit";
import { MapCamera } from "./map_camera.js";
import { baysOf } from "./map_bays.js";
import { drawing, spread } from "./map_drawing.js";
import { factsOf } from "./map_facts.js";
import { MapGestures } from "./map_gestures.js";
import { placeLabels } from "./map_labels.js";
import { aheadOf, signBox, wordingsOf } from "./map_notes.js";
import { sizeOf, spreadOf, windowOf } from "./map_view.js";
import { shortestWay } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { withStyles } from "../elements/styles_later.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { closedSigns, corridorLines, drivingMarks, label, postMark, silentPlaces, occupiedBands, occupiedSigns, wayLines } from "./map_parts.js";
import { inCorridors } from "./map_places.js";
import { mapTools } from "./map_tools.js";
import { mapLegend, placesInWords } from "./map_words.js";
import { PageElement } from "../elements/page_element.js";
import { robotFacts } from "./robot_facts.js";
/** @import { Alarm, CampusMap, ClosedCorridor, OccupiedCorridor, ReportedPlace, Robot } from "../../types/api_types.ts" */
/** @import { Box, Drawing, Point } from "./map_drawing.js" */
/** @import { MapFacts } from "./map_facts.js" */
/** @import { Place, Wording } from "./map_labels.js" */

let maps = 0;

export class CampusMapElement extends PageElement {
  #camera = new MapCamera(this);
  #gestures = new MapGestures(this.#camera, (screen) => this.#toMap(screen));
  #resized = new ResizeObserver(() => this.#measure());
  #hatch = `no-network-${(maps += 1)}`;
  /** Pixels of the screen per unit of the whole map, and the room beside it in units. */
  #pixels = 1;
  #beside = 0;
  /** The names as last placed, and what for. */
  #placed = { key: "", places: /** @type {Map<string, Place>} */ (new Map()) };

  static properties = {
    map: { attribute: false },
    robots: { attribute: false },
    traffic: { attribute: false },
    reported: { attribute: false },
    alarms: { attribute: false },
    closed: { attribute: false },
    arrival: { attribute: false },
    from: {},
    to: {},
    facts: { type: Boolean },
  };

  constructor() {
    super();
    /** @type {CampusMap | null} */
    this.map = null;
    /** @type {readonly Robot[]} the robots to show */
    this.robots = [];
    /** @type {readonly OccupiedCorridor[]} who holds which corridor; what others hold than these robots is not shown */
    this.traffic = [];
    /** @type {readonly ReportedPlace[]} what robots report to be in, on maps with bays */
    this.reported = [];
    /** @type {readonly Alarm[]} of which some say that a corridor is closed */
    this.alarms = [];
    /** @type {readonly ClosedCorridor[]} into which no robot is let */
    this.closed = [];
    /** @type {MapFacts["arrival"]} of the order that it is about, if it is about one */
    this.arrival = null;
    this.from = "";
    this.to = "";
    /** True if the list of robots is shown below the map. */
    this.facts = false;
    new Ticking(this);
  }

  connectedCallback() {
    super.connectedCallback();
    this.#resized.observe(this);
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    this.#resized.disconnect();
  }

  render() {
    const { map } = this;
    if (!map) return nothing;
    const facts = factsOf(map, this.robots, this.traffic, this.reported, this.alarms, this.closed, serverNow(), this.arrival);
    const whole = drawing(map);
    this.#camera.lookAt(whole.frame);
    return html`<figure class="campus">
      <div class="area" tabindex="0" role="group" aria-label=${t("map.area")} @keydown=${this.#gestures.key}>
        ${this.#svg(map, whole, facts)}
      </div>
      ${mapTools(this.#camera, robotPoints(whole, facts), facts.robots.length)}
      <div class="map-told">
        ${mapLegend(map, facts)}
        ${this.#list(map, facts)}
        ${placesInWords(map)}
      </div>
    </figure>`;
  }

  /** @param {CampusMap} map @param {Drawing} whole @param {MapFacts} facts */
  #svg(map, whole, facts) {
    const { view, target, framed } = this.#camera;
    const size = sizeOf(this.#pixels, view.zoom);
    const { x, y, width, height } = windowOf(view, whole.frame, size);
    const wordings = wordingsOf(map, facts, [this.from, this.to]);
    const letters = sizeOf(this.#pixels, target.zoom);
    const seen = framed.zoom === target.zoom && framed.zoom > 1 ? windowOf(framed, whole.frame, letters) : null;
    const places = this.#places(whole, wordings, { factor: spreadOf(target, letters), seen, beside: this.#beside / letters }, facts);
    const drawn = spread(whole, spreadOf(view, size));
    const { down, drag, up, wheel } = this.#gestures;
    return html`<svg class=${this.#camera.isWhole ? "" : "closer"} viewBox="${x} ${y} ${width} ${height}" role="img"
      aria-label=${t("map.title", { title: map.title })} @pointerdown=${down} @pointermove=${drag} @pointerup=${up}
      @pointercancel=${up} @wheel=${wheel}>
      ${silentPlaces(drawn, this.#hatch)} ${occupiedBands(drawn, facts.taken)} ${corridorLines(drawn)}
      ${wayLines(drawn, this.#way(map), "way")} ${facts.robots.map((robot) => wayLines(drawn, aheadOf(map, robot), "ahead"))}
      ${occupiedSigns(drawn, facts.ahead, facts.robots.length > 1)} ${closedSigns(drawn, facts.shut)}
      ${drawn.posts.map((post) => postMark(post, this.#at(post.name, facts)))}
      ${drivingMarks(drawn, facts.between, facts.robots.length > 1)}
      ${this.above(drawn)}
      ${wordings.map((wording) => this.#label(drawn, wording, places.get(wording.name)))}
    </svg>`;
  }

  /** More to be drawn above the robots, by elements that extend this one. @param {Drawing} _drawn @returns {unknown} */
  above(_drawn) {
    return nothing;
  }

  /** Folded up where the robots are told of elsewhere on the page. @param {CampusMap} map @param {MapFacts} facts */
  #list(map, facts) {
    if (!this.facts && !facts.robots.length) return nothing;
    const list = robotFacts(map, facts, this.from, this.to);
    if (!this.facts) return html`<details class="places"><summary>${t("map.facts")}</summary>${list}</details>`;
    return html`<p class="hint">${t(map.posts.some((post) => baysOf(post).length) ? "map.legend.honest.bays" : "map.legend.honest")} ${map.corridors.some(({ assumed }) => assumed) ? t("map.assumed") : nothing}</p>
      <h3>${t("map.facts")}</h3>
      ${list}`;
  }

  /** @param {string} post @param {MapFacts} facts */
  #at(post, { standing, expected }) {
    const isEnd = post === this.from || post === this.to;
    return { isEnd, isGoal: post === this.to, seen: standing.get(post) ?? [], expected: expected.get(post) ?? [], inBays: standing };
  }

  /** Where the names stand: looked for again when what they say has another length, not with each second of an age.
   *  @param {Drawing} whole @param {Wording[]} wordings @param {{factor: number, seen: Box | null, beside: number}} room `seen`: if not
   *  the whole @param {MapFacts} facts */
  #places(whole, wordings, room, { ahead, between, robots }) {
    const driving = between.map((one) => ({ ...one, robot: one.robot.name }));
    const signs = [...(robots.length > 1 ? ahead : []), ...driving];
    const steady = wordings.map((wording) => ({ ...wording, notes: wording.notes.map((note) => note.replace(/\d/g, "0")) }));
    const key = JSON.stringify([this.map?.version, this.map?.name, room, steady, signs]);
    if (key !== this.#placed.key) {
      const drawn = spread(whole, room.factor);
      const inside = widened(room.seen ?? drawn.frame, room.beside);
      this.#placed = { key, ...placeLabels(drawn, steady, inside, signs.map((sign) => signBox(drawn, sign))) };
    }
    return this.#placed.places;
  }

  /** @param {Drawing} drawn @param {Wording} wording @param {Place | undefined} place */
  #label(drawn, wording, place) {
    const post = drawn.posts.find(({ name }) => name === wording.name);
    return post && place ? label(post, wording, place) : nothing;
  }

  /** @param {CampusMap} map */
  #way(map) {
    return this.from && this.to && this.from !== this.to ? shortestWay(map, this.from, this.to) : [];
  }

  #measure() {
    const { width, height } = this.querySelector("svg")?.getBoundingClientRect() ?? { width: 0, height: 0 };
    const frame = this.map && drawing(this.map).frame;
    if (!frame || !width) return;
    const pixels = Math.min(width / frame.width, height / frame.height);
    const beside = Math.round(Math.max(0, width / pixels - frame.width) / 2);
    if (Math.abs(pixels - this.#pixels) < 0.01 && beside === this.#beside) return;
    [this.#pixels, this.#beside] = [pixels, beside];
    this.requestUpdate();
  }

  /** From the screen into the drawing. @param {Point} screen @returns {Point} */
  #toMap({ x, y }) {
    const { left, top, width, height } = /** @type {Element} */ (this.querySelector("svg")).getBoundingClientRect();
    const { view } = this.#camera;
    const scale = this.#pixels * view.zoom;
    return { x: view.x + (x - left - width / 2) / scale, y: view.y + (y - top - height / 2) / scale };
  }
}

/** Where robots are drawn. @param {Drawing} whole @param {MapFacts} facts @returns {Point[]} */
const robotPoints = (whole, { seen, between }) => [...whole.posts.filter(({ name }) => seen.has(name)), ...inCorridors(whole, between)];

/** @param {Box} frame @param {number} beside @returns {Box} */
const widened = ({ x, y, width, height }, beside) => ({ x: x - beside, y, width: width + 2 * beside, height });

await withStyles("/src/styles/map.css");
customElements.define("campus-map", CampusMapElement);
