/**
 * The live diagnostics received so far: the newest of everything, what changed, and all of it for the download.
 * @import { Diagnostics, TraceLine, Watched } from "../../types/api_types.ts"
 * @typedef {TraceLine & {id: number}} NumberedLine
 * @typedef {{id: number, came: boolean, text: string, at: string}} Change a belief that came or went
 * @typedef {object} Seen what is drawn; a newer one never changes an older one
 * @property {Diagnostics | null} insight the newest
 * @property {Diagnostics["loops"]} loops the newest told
 * @property {string[]} beliefs in alphabetical order
 * @property {Change[]} changes newest first
 * @property {NumberedLine[]} lines newest first
 * @property {number} told how many insights
 * @property {number} missed how many are known to be missing
 * @property {number} left_out lines of the trace that had no room
 */

const MOST_LINES = 2_000;
const MOST_CHANGES = 200;
/** An hour, at two a second. */
const MOST_KEPT = 7_200;
/** Of the file that is downloaded (docs/explanation/pages.md). */
const FORMAT = 1;

export class DiagnosticsRun {
  /** As text, which takes least room. @type {string[]} */
  #record = [];
  #began = "";
  #dropped = 0;
  #count = 0;
  /** @type {Set<string>} */
  #beliefs = new Set();
  /** The number of the insight up to which none is missing; 0: the first is. */
  #believed_until = 0;
  /** @type {Seen} */
  seen = { insight: null, loops: [], beliefs: [], changes: [], lines: [], told: 0, missed: 0, left_out: 0 };

  /** @param {string} robot */
  constructor(robot) {
    this.robot = robot;
  }

  /** @param {Watched} watched */
  take(watched) {
    const { insight } = watched;
    this.#keep(watched);
    const before = this.seen;
    const missed = before.insight && !insight.whole ? Math.max(0, insight.number - before.insight.number - 1) : 0;
    this.#believe(insight);
    this.seen = {
      insight,
      loops: insight.loops.length ? insight.loops : before.loops,
      beliefs: [...this.#beliefs].sort((a, b) => a.localeCompare(b)),
      changes: [...this.#changes(insight), ...before.changes].slice(0, MOST_CHANGES),
      lines: [...this.#numbered(insight.trace), ...before.lines].slice(0, MOST_LINES),
      told: before.told + 1,
      missed: before.missed + missed,
      left_out: before.left_out + insight.left_out.trace,
    };
  }

  /** @param {Watched} watched */
  #keep(watched) {
    this.#began ||= watched.at;
    this.#record.push(JSON.stringify(watched));
    if (this.#record.length <= MOST_KEPT) return;
    this.#record.shift();
    this.#dropped += 1;
  }

  /** True if all beliefs are needed anew: none were received yet, or some reports are missing. */
  get isIncomplete() {
    return this.#believed_until !== this.seen.insight?.number;
  }

  /** @param {Diagnostics} insight */
  #believe({ number, whole, came, went }) {
    if (whole || this.#believed_until === number - 1) this.#believed_until = number;
    if (whole) this.#beliefs.clear();
    for (const text of went) this.#beliefs.delete(text);
    for (const text of came) this.#beliefs.add(text);
  }

  /** The whole list is no change. @param {Diagnostics} insight @returns {Change[]} */
  #changes({ whole, came, went, at }) {
    if (whole) return [];
    const change = (/** @type {boolean} */ came) => (/** @type {string} */ text) => ({ id: ++this.#count, came, text, at });
    return [...went.map(change(false)), ...came.map(change(true))].reverse();
  }

  /** @param {TraceLine[]} lines @returns {NumberedLine[]} newest first */
  #numbered(lines) {
    return lines.map((line) => ({ ...line, id: ++this.#count })).reverse();
  }

  /** One JSON object a line: what this is, then everything as the service sent it. */
  asJsonLines() {
    const head = { campus_mail_watched_run: FORMAT, robot: this.robot, insights: this.#record.length, dropped: this.#dropped };
    return [JSON.stringify(head), ...this.#record].map((line) => `${line}\n`).join("");
  }

  /** A name for the file, from when it begins. */
  get fileName() {
    return `${this.robot}-${this.#began.slice(0, 19).replaceAll(":", "-")}.jsonl`;
  }
}
