/** The buttons below a map: closer, farther, the whole, to the robots. */
import { html, nothing } from "lit";
import { STEP } from "./map_gestures.js";
import { t } from "../texts/texts.js";
import { icon } from "../elements/icon.js";
/** @import { MapCamera } from "./map_camera.js" */
/** @import { Point } from "./map_drawing.js" */

/** @param {MapCamera} camera @param {readonly Point[]} seen where robots were seen @param {number} robots */
export const mapTools = (camera, seen, robots) => html`<div class="map-tools" role="group" aria-label=${t("map.tools")}>
  ${seen.length ? tool("robot", t(robots === 1 ? "map.to_robot" : "map.to_robots"), false, () => camera.show(seen)) : nothing}
  ${tool("whole", t("map.whole"), camera.isWhole, camera.showWhole)}
  ${tool("farther", t("map.farther"), camera.isWhole, () => camera.zoom(1 / STEP))}
  ${tool("closer", t("map.closer"), camera.isClosest, () => camera.zoom(STEP))}
</div>`;

/** A button that can do nothing now keeps the keyboard. @param {Parameters<typeof icon>[0]} drawing @param {string} name
 *  @param {boolean} isIdle @param {() => void} act */
const tool = (drawing, name, isIdle, act) => html`<button type="button" class="tool" aria-label=${name} title=${name}
  aria-disabled=${isIdle ? "true" : nothing} @click=${act}>${icon(drawing)}</button>`;
