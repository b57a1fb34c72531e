/** Sensor readings of a robot: its shape from above with what is pressed or near, and the same in words. */
import { html, nothing, svg } from "lit";
import { hasText, t } from "../texts/texts.js";
import { decimal } from "../texts/times.js";
/** @import { Diagnostics, Sensors } from "../../types/api_types.ts" */

const LIGHTS = ["left", "front_left", "centre_left", "centre_right", "front_right", "right"];
const MIDDLE = 70;
const [BUMPER, LIGHT] = [58, 48];

/** @param {Sensors} sensors @param {Diagnostics["loops"]} loops */
export function sensorPanel(sensors, loops) {
  return html`<div class="senses-now">${shape(sensors)} ${words(sensors)}</div>
    ${loops.length ? timings(loops) : nothing}`;
}

/** A point of a circle; 0° is straight ahead, to the right positive. @param {number} radius @param {number} degrees */
function at(radius, degrees) {
  const angle = (degrees * Math.PI) / 180;
  return `${(MIDDLE + radius * Math.sin(angle)).toFixed(1)} ${(MIDDLE - radius * Math.cos(angle)).toFixed(1)}`;
}

/** @param {number} radius @param {number} from @param {number} to */
const arc = (radius, from, to) => `M${at(radius, from)}A${radius} ${radius} 0 0 1 ${at(radius, to)}`;

/** @param {boolean} on */
const lit = (on) => (on ? "on" : "off");

/** @param {Sensors} sensors */
function shape({ bumps, drops, light_bumpers, line }) {
  const hung = (/** @type {string} */ side) => drops.some((drop) => drop.includes(side));
  return html`<svg class="robot-shape" viewBox="0 0 140 140" aria-hidden="true">
    <circle class="body" cx=${MIDDLE} cy=${MIDDLE} r="52" />
    ${svg`<path class="bumper ${lit(bumps.includes("left"))}" d=${arc(BUMPER, -80, -3)}/>
      <path class="bumper ${lit(bumps.includes("right"))}" d=${arc(BUMPER, 3, 80)}/>
      <rect class="wheel ${lit(hung("left"))}" x="24" y="58" width="9" height="26" rx="3"/>
      <rect class="wheel ${lit(hung("right"))}" x="107" y="58" width="9" height="26" rx="3"/>`}
    ${LIGHTS.map((name, i) => svg`<path class="light ${lit(light_bumpers.includes(/** @type {any} */ (name)))}" d=${arc(LIGHT, -75 + 25 * i + 4, -75 + 25 * (i + 1) - 4)}/>`)}
    ${line.map((over, i) => svg`<circle class="diode ${lit(over)}" cx=${MIDDLE - 14 + 14 * i} cy="44" r="4.5"/>`)}
  </svg>`;
}

/** @param {string[]} names @param {string} none the text for none of them */
const listed = (names, none) => (names.length ? names.map((name) => t(`sensor.at.${name}`)).join(", ") : t(none));

/** A word of the robot's own, in this page's language where the catalogue has it. @param {string} family @param {string} word */
const known = (family, word) => (hasText(`sensor.${family}.${word}`) ? t(`sensor.${family}.${word}`) : word.replaceAll("_", " "));

/** @param {Sensors} sensors */
function words(sensors) {
  const { bumps, drops, light_bumpers, line_word, wheels_mm_s, skill, mode, faults, docked, charging_state } = sensors;
  const { voltage_mv, current_ma, temperature_c, base_age_s, camera_age_s } = sensors;
  /** @type {[string, string, boolean][]} name, value, whether it is worth a look */
  const rows = [
    ["doing", skill ? known("skill", skill) : t("sensor.standing"), false],
    ["wheels", t("sensor.speeds", { left: decimal(wheels_mm_s[0], 0), right: decimal(wheels_mm_s[1], 0) }), false],
    ["line", known("line", line_word), line_word === "lost"],
    ["bumper", listed(bumps, "sensor.bumper_free"), bumps.length > 0],
    ["near", listed(light_bumpers, "sensor.near_nothing"), light_bumpers.length > 0],
    ["drops", listed(drops, "sensor.drops_none"), drops.length > 0],
    ["base", mode ? t("sensor.base_said", { mode: known("mode", mode), age: decimal(base_age_s ?? 0, 2) }) : t("sensor.base_silent"), !mode],
    ["dock", docked ? t("sensor.docked", { state: known("charge", charging_state ?? "") }) : t("sensor.not_docked"), false],
    ["power", voltage_mv === null || voltage_mv === undefined ? "" : power(voltage_mv, current_ma ?? 0, temperature_c ?? 0), false],
    ["camera", camera_age_s === null || camera_age_s === undefined ? "" : t("sensor.camera_age", { age: decimal(camera_age_s, 1) }), (camera_age_s ?? 0) > 1],
    ["faults", faults.length ? faults.map((name) => known("fault", name)).join(", ") : t("sensor.faults_none"), faults.length > 0],
  ];
  return html`<dl class="facts-list">
    ${rows.map(([name, value, odd]) => html`<div class=${odd ? "odd" : nothing}><dt>${t(`sensor.of.${name}`)}</dt><dd>${value}</dd></div>`)}
  </dl>`;
}

/** @param {number} voltage_mv @param {number} current_ma @param {number} temperature_c */
const power = (voltage_mv, current_ma, temperature_c) =>
  t("sensor.power", { volts: decimal(voltage_mv / 1000, 1), amperes: decimal(current_ma / 1000, 2), degrees: decimal(temperature_c, 0) });

/** @param {Diagnostics["loops"]} loops */
function timings(loops) {
  return html`<details>
    <summary>${t("sensor.loops")}</summary>
    <div class="wide" tabindex="0" role="region" aria-label=${t("sensor.loops")}>
      <table>
        <thead><tr>${["name", "ticks", "half", "most", "worst"].map((name) => html`<th scope="col">${t(`sensor.loop.${name}`)}</th>`)}</tr></thead>
        <tbody>${loops.map(
          ({ name, ticks, late_p50_ms, late_p99_ms, late_worst_ms }) => html`<tr>
            <th scope="row">${name}</th><td>${decimal(ticks, 0)}</td>
            ${[late_p50_ms, late_p99_ms, late_worst_ms].map((late_ms) => html`<td>${t("sensor.ms", { ms: decimal(late_ms, 1) })}</td>`)}
          </tr>`,
        )}</tbody>
      </table>
    </div>
  </details>`;
}
