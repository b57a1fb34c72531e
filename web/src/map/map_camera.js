/**
 * Which part of a map an element shows, and how it gets there: smoothly, unless the user prefers less motion.
 * @import { ReactiveController, ReactiveControllerHost } from "lit"
 * @import { Box, Point } from "./map_drawing.js"
 * @import { View } from "./map_view.js"
 */
import { CLOSEST, moved, onTheWay, showing, whole, zoomed } from "./map_view.js";

const GLIDE_MS = 220;
const NOTHING = { x: 0, y: 0, width: 1, height: 1 };
const wantsLessMotion = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** @implements {ReactiveController} */
export class MapCamera {
  #frame = /** @type {Box} */ (NOTHING);
  #animation = 0;
  /** The current view. */
  view = whole(NOTHING);
  /** Where that is going: names are placed for this, so that they do not jump on the way. */
  target = this.view;
  /** The last view requested by a button or key: names stay inside it. Dragging does not change it. */
  framed = this.view;

  /** @param {ReactiveControllerHost} host */
  constructor(host) {
    this.host = host;
    host.addController(this);
  }

  hostDisconnected() {
    cancelAnimationFrame(this.#animation);
    this.view = this.target;
  }

  /** Set the frame of the drawing; a new frame is shown whole. @param {Box} frame */
  lookAt(frame) {
    if (frame === this.#frame) return;
    cancelAnimationFrame(this.#animation);
    this.#frame = frame;
    this.view = this.target = this.framed = whole(frame);
  }

  get isWhole() {
    return this.target.zoom === 1;
  }

  get isClosest() {
    return this.target.zoom === CLOSEST;
  }

  showWhole = () => this.#look(whole(this.#frame));

  /** @param {readonly Point[]} points */
  show = (points) => this.#look(showing(points, this.#frame));

  /** @param {number} factor */
  zoom = (factor) => this.#look(zoomed(this.target, this.#frame, factor));

  /** As fingers or a wheel say, at once. @param {number} factor @param {Point} at */
  zoomAt(factor, at) {
    this.#jump(zoomed(this.view, this.#frame, factor, at));
  }

  /** @param {number} dx @param {number} dy */
  move(dx, dy) {
    this.#jump(moved(this.view, this.#frame, dx, dy));
  }

  /** By parts of what is seen. @param {number} right @param {number} down */
  step(right, down) {
    const { width, height } = this.#frame;
    const { zoom } = this.target;
    this.#glide(moved(this.target, this.#frame, (right * width) / zoom, (down * height) / zoom));
  }

  /** @param {View} view */
  #look(view) {
    this.framed = view;
    this.#glide(view);
  }

  /** @param {View} view */
  #jump(view) {
    cancelAnimationFrame(this.#animation);
    this.view = this.target = view;
    this.host.requestUpdate();
  }

  /** @param {View} target */
  #glide(target) {
    if (wantsLessMotion()) return this.#jump(target);
    cancelAnimationFrame(this.#animation);
    const from = this.view;
    const began = performance.now();
    const draw = () => {
      const part = Math.min(1, (performance.now() - began) / GLIDE_MS);
      this.view = onTheWay(from, target, 1 - (1 - part) ** 3);
      this.host.requestUpdate();
      if (part < 1) this.#animation = requestAnimationFrame(draw);
    };
    this.target = target;
    draw();
  }
}
