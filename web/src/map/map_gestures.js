/**
 * Fingers, mouse, wheel and keys on a map. One finger scrolls the page unless the map is zoomed in (the style's
 * touch-action says the same to the browser); the wheel scrolls the page unless Ctrl is held.
 * @import { MapCamera } from "./map_camera.js"
 * @import { Point } from "./map_drawing.js"
 */

export const STEP = 1.5;
const ARROWS = /** @type {Record<string, [number, number]>} */ ({
  ArrowLeft: [-0.2, 0],
  ArrowRight: [0.2, 0],
  ArrowUp: [0, -0.2],
  ArrowDown: [0, 0.2],
});
/** Of a wheel, in pixels, that double the size. */
const DOUBLES = 240;
const PIXELS_PER_LINE = 16;

export class MapGestures {
  /** @type {Map<number, Point>} fingers on the map, where they are on the screen */
  #fingers = new Map();

  /** @param {MapCamera} camera @param {(screen: Point) => Point} toMap from the screen into the drawing */
  constructor(camera, toMap) {
    this.camera = camera;
    this.toMap = toMap;
  }

  down = (/** @type {PointerEvent} */ event) => {
    if (event.button !== 0) return;
    this.#fingers.set(event.pointerId, at(event));
    if (!this.camera.isWhole || this.#fingers.size > 1) /** @type {Element} */ (event.currentTarget).setPointerCapture(event.pointerId);
  };

  up = (/** @type {PointerEvent} */ event) => void this.#fingers.delete(event.pointerId);

  drag = (/** @type {PointerEvent} */ event) => {
    if (!this.#fingers.has(event.pointerId)) return;
    const before = [...this.#fingers.values()];
    this.#fingers.set(event.pointerId, at(event));
    const now = [...this.#fingers.values()];
    if (now.length > 1) this.camera.zoomAt(apart(now) / (apart(before) || 1), this.toMap(middle(before)));
    if (now.length > 1 || !this.camera.isWhole) this.#carry(middle(before), middle(now));
  };

  wheel = (/** @type {WheelEvent} */ event) => {
    if (!event.ctrlKey && !event.metaKey) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? PIXELS_PER_LINE : 1);
    this.camera.zoomAt(2 ** (-pixels / DOUBLES), this.toMap(at(event)));
  };

  key = (/** @type {KeyboardEvent} */ event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const arrow = ARROWS[event.key];
    if (arrow && this.camera.isWhole) return; // the page scrolls
    if (arrow) this.camera.step(...arrow);
    else if (event.key === "+" || event.key === "=") this.camera.zoom(STEP);
    else if (event.key === "-") this.camera.zoom(1 / STEP);
    else if (event.key === "0") this.camera.showWhole();
    else return;
    event.preventDefault();
  };

  /** Keep the point under the fingers there. @param {Point} from @param {Point} to */
  #carry(from, to) {
    const [before, now] = [this.toMap(from), this.toMap(to)];
    this.camera.move(before.x - now.x, before.y - now.y);
  }
}

/** @param {MouseEvent} event @returns {Point} */
const at = ({ clientX, clientY }) => ({ x: clientX, y: clientY });

/** @param {Point[]} points @returns {Point} */
const middle = (points) => ({
  x: points.reduce((sum, { x }) => sum + x, 0) / points.length,
  y: points.reduce((sum, { y }) => sum + y, 0) / points.length,
});

/** @param {Point[]} points */
const apart = ([a, b]) => Math.hypot(a.x - b.x, a.y - b.y);
