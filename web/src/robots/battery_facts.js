/**
 * A robot's charge over time: what the curve draws and what the words beside it say. Pure.
 * @import { BatteryHistory } from "../../types/api_types.ts"
 * @typedef {BatteryHistory["samples"][number]} Sample
 * @typedef {{from: string, to: string, from_ratio: number, to_ratio: number}} Charge from when until when it was charged
 */

export const WIDTH = 640;
export const HEIGHT = 200;
/** Nothing heard for so long is drawn as nothing: a robot without network tells no charge. */
const GAP_MS = 15 * 60_000;

/** The least that the axis spans: of a robot just switched on, a minute's tremble is not a fall. */
const LEAST_MS = 15 * 60_000;

/** The same, from where there is something to draw. @param {BatteryHistory} history @returns {BatteryHistory} */
export function fromItsFirst(history) {
  const { samples, since, until } = history;
  if (!samples.length) return history;
  const first_ms = Math.min(Date.parse(samples[0].at), Date.parse(until) - LEAST_MS);
  return { ...history, since: new Date(Math.max(Date.parse(since), first_ms)).toISOString() };
}

/** @param {BatteryHistory} history */
function scale({ since, until }) {
  const [from_ms, to_ms] = [Date.parse(since), Date.parse(until)];
  const span_ms = Math.max(1, to_ms - from_ms);
  return (/** @type {string} */ at) => (WIDTH * (Date.parse(at) - from_ms)) / span_ms;
}

/** The height of a ratio in the drawing. @param {number} ratio */
export const height = (ratio) => HEIGHT * (1 - Math.min(1, Math.max(0, ratio)));

/** Samples without a long silence between them. @param {BatteryHistory} history @returns {Sample[][]} */
function runs({ samples, since, until }) {
  // A long time is thinned: then two samples are farther apart than their minute.
  const gap_ms = Math.max(GAP_MS, (Date.parse(until) - Date.parse(since)) / 60);
  return samples.reduce((found, sample) => {
    const last = found.at(-1)?.at(-1);
    if (last && Date.parse(sample.at) - Date.parse(last.at) <= gap_ms) found.at(-1)?.push(sample);
    else found.push([sample]);
    return found;
  }, /** @type {Sample[][]} */ ([]));
}

/** The `d` of a path, broken where nothing was heard. @param {BatteryHistory} history */
export function curve(history) {
  const x = scale(history);
  const point = (/** @type {Sample} */ { at, ratio }, /** @type {number} */ i) => `${i ? "L" : "M"}${x(at).toFixed(1)} ${height(ratio).toFixed(1)}`;
  return runs(history).map((run) => (run.length > 1 ? run.map(point).join("") : dot(point(run[0], 0)))).join("");
}

/** One sample alone. @param {string} move */
const dot = (move) => `${move}h0.1`;

/** Where it was charged, as bands. @param {BatteryHistory} history @returns {{x: number, width: number}[]} */
export function bands(history) {
  const x = scale(history);
  return charges(history).map(({ from, to }) => ({ x: x(from), width: Math.max(1, x(to) - x(from)) }));
}

/** @param {BatteryHistory} history @returns {Charge[]} oldest first */
export function charges(history) {
  return runs(history).flatMap((run) => {
    /** @type {Charge[]} */
    const found = [];
    run.forEach((sample, i) => {
      const began = sample.charging && !run[i - 1]?.charging;
      if (began) found.push({ from: sample.at, to: sample.at, from_ratio: sample.ratio, to_ratio: sample.ratio });
      const last = found.at(-1);
      if (last && (sample.charging || run[i - 1]?.charging)) [last.to, last.to_ratio] = [sample.at, sample.ratio];
    });
    return found;
  });
}

/** The sample with the least charge. @param {Sample[]} samples */
export const lowest = (samples) => samples.reduce((low, sample) => (sample.ratio < low.ratio ? sample : low));

/** So many of them for a table, the first and the last among them. @param {Sample[]} samples @param {number} most */
export function some(samples, most) {
  const each = Math.max(1, Math.ceil((samples.length - 1) / (most - 1)));
  return samples.filter((_, i) => i % each === 0 || i === samples.length - 1);
}
