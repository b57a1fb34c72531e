/** Times as people read them, and as mails say them (app/core/texts/times.py). Times go in as the service writes them. */
import { locale, t } from "./texts.js";

const HOUR_MS = 3_600_000;
const DAY_MS = 24 * HOUR_MS;
const JUST_NOW_MS = 5_000;

/** One of each kind: a phone takes 10 ms to make one. @type {Map<string, Intl.DateTimeFormat>} */
const formats = new Map();

/** @param {Intl.DateTimeFormatOptions} options */
function format(options) {
  const kind = locale() + JSON.stringify(options);
  const known = formats.get(kind) ?? new Intl.DateTimeFormat(locale(), options);
  formats.set(kind, known);
  return known;
}

const CLOCK = /** @type {const} */ ({ hour: "numeric", minute: "2-digit" });
const DAY_AND_CLOCK = /** @type {const} */ ({ day: "numeric", month: "short", ...CLOCK });

/** No line ends inside of "1:57 p.m.", "13 h 57" or "22 nov." @param {string} said */
const held = (said) => said.replace(/\b \b/g, "\u00a0");

/** @param {string} at @param {number} now_ms */
const isToday = (at, now_ms) => new Date(at).toDateString() === new Date(now_ms).toDateString();

/** "2:05 p.m.", "14 h 05" @param {string} at */
export const clockTime = (at) => held(format(CLOCK).format(new Date(at)));

/** "12:40 – 12:44 p.m."; with its day unless it is today's. @param {{from: string, to: string}} window @param {number} [now_ms] */
export const windowText = ({ from, to }, now_ms = Date.parse(from)) =>
  held(format(isToday(from, now_ms) ? CLOCK : DAY_AND_CLOCK).formatRange(new Date(from), new Date(to)));

/** A phone takes 50 ms to say its first time: done before a page needs it. */
export const prepareTimes = () => void windowText({ from: "2024-01-01T12:00Z", to: "2024-01-01T12:05Z" });

/** A day and a time; today needs no day. @param {string} at @param {number} now_ms */
export const dayAndTime = (at, now_ms) =>
  isToday(at, now_ms) ? clockTime(at) : held(format(DAY_AND_CLOCK).format(new Date(at)));

/** "9:30 a.m." @param {string} at a time of day in no particular zone, as 09:30 */
export const wallClock = (at) => held(format({ ...CLOCK, timeZone: "UTC" }).format(new Date(`2024-01-01T${at}Z`)));

/** The name of a weekday. @param {number} day 0 is Monday @param {"long" | "short"} [style] */
export const weekdayName = (day, style = "long") =>
  format({ weekday: style, timeZone: "UTC" }).format(Date.UTC(2024, 0, 1 + day));

/** "Monday and Friday" @param {number[]} days 0 is Monday */
export const weekdayNames = (days) =>
  new Intl.ListFormat(locale()).format([...days].sort().map((day) => weekdayName(day, days.length > 2 ? "short" : "long")));

/** "2 min ago", from a day on the date. @param {string} at @param {number} now_ms the service's time, not the machine's */
export function ago(at, now_ms) {
  const age_ms = now_ms - Date.parse(at);
  if (age_ms < JUST_NOW_MS) return t("time.just_now");
  if (age_ms >= DAY_MS) return dayAndTime(at, now_ms);
  const relative = new Intl.RelativeTimeFormat(locale(), { style: "short" });
  if (age_ms < 60_000) return relative.format(-Math.floor(age_ms / 1000), "second");
  if (age_ms < HOUR_MS) return relative.format(-Math.floor(age_ms / 60_000), "minute");
  return relative.format(-Math.floor(age_ms / HOUR_MS), "hour");
}

/** "2:05:07 p.m." @param {string} at */
export const clockSeconds = (at) => held(format({ ...CLOCK, second: "2-digit" }).format(new Date(at)));

/** "1,234.5" @param {number} value @param {number} digits behind the point */
export const decimal = (value, digits) =>
  new Intl.NumberFormat(locale(), { minimumFractionDigits: digits, maximumFractionDigits: digits }).format(value);

/** "85 %" @param {number} ratio */
export const percent = (ratio) => new Intl.NumberFormat(locale(), { style: "percent" }).format(ratio);

/** "2 m", "1.2 km" @param {number} length_m */
export const length = (length_m) =>
  length_m < 1000
    ? new Intl.NumberFormat(locale(), { style: "unit", unit: "meter", maximumFractionDigits: 0 }).format(length_m)
    : new Intl.NumberFormat(locale(), { style: "unit", unit: "kilometer", maximumFractionDigits: 1 }).format(length_m / 1000);
