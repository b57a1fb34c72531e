/**
 * A robot's senses and mind, live: what it feels, intends and believes, and what it chose and why. While this stands on
 * the page the robot is asked to tell; what was told can be held still, looked through, and taken away as a file.
 */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { isLive, OnLive } from "../live/live.js";
import { inWords } from "../service/problems.js";
import { counted, t } from "../texts/texts.js";
import { DiagnosticsRun } from "./diagnostics_run.js";
import { beliefList } from "./belief_list.js";
import { problemLine } from "../elements/field.js";
import "./intention_tree.js";
import { PageElement } from "../elements/page_element.js";
import { planTrace } from "./plan_trace.js";
import { sensorPanel } from "./sensor_panel.js";
/** @import { Watched } from "../../types/api_types.ts" */
/** @import { Seen } from "./diagnostics_run.js" */

const SAY_AGAIN_MS = 10_000;

export class RobotDiagnostics extends PageElement {
  #timer = 0;
  /** Seconds may have passed since this page was looked at last. */
  #back = () => document.hidden || this.#say();
  /** @type {DiagnosticsRun} */
  #run = new DiagnosticsRun("");

  static properties = {
    robot: { attribute: false },
    online: { type: Boolean },
    seen: { state: true },
    held: { state: true },
    tells: { state: true },
    problem: { state: true },
    beliefFilter: { state: true },
    traceFilter: { state: true },
    kind: { state: true },
  };

  constructor() {
    super();
    this.robot = "";
    this.online = false;
    /** @type {Seen} */
    this.seen = this.#run.seen;
    /** The count of reports when the view was paused; null: not paused. @type {number | null} */
    this.held = null;
    /** True if this robot's software supports live diagnostics. */
    this.tells = true;
    this.problem = "";
    this.beliefFilter = this.traceFilter = this.kind = "";
    new OnLive(this, {
      insight: (watched) => this.#take(watched),
      connected: (connected) => connected && this.hasUpdated && this.#say(),
    });
  }

  connectedCallback() {
    super.connectedCallback();
    this.#timer = setInterval(this.#back, SAY_AGAIN_MS);
    document.addEventListener("visibilitychange", this.#back);
  }

  disconnectedCallback() {
    super.disconnectedCallback();
    clearInterval(this.#timer);
    document.removeEventListener("visibilitychange", this.#back);
  }

  /** @param {Map<string, unknown>} changed */
  willUpdate(changed) {
    if (changed.has("robot")) this.#run = new DiagnosticsRun(this.robot);
  }

  /** Reports come by the event stream alone, and once: ask for them only when the stream stands. */
  firstUpdated() {
    if (isLive()) this.#say();
  }

  render() {
    const { insight } = this.seen;
    return html`<div class="watch-bar">
        <p role="status">${this.#standing()}</p>
        <button type="button" aria-pressed=${this.held === null ? "false" : "true"} @click=${this.#hold}>
          ${t(this.held === null ? "mind.pause" : "mind.go_on")}
        </button>
        <button type="button" ?disabled=${!insight} @click=${this.#download}>${t("mind.download")}</button>
      </div>
      ${insight ? html`<p class="hint">${t("mind.download.hint")}</p>` : nothing}
      ${this.problem ? problemLine(this.problem) : nothing}
      ${insight ? this.#parts(this.seen, insight) : nothing}`;
  }

  /** @param {Seen} seen @param {NonNullable<Seen["insight"]>} insight */
  #parts(seen, insight) {
    return html`<section class="card intends" aria-labelledby="mind-title">
        <h2 id="mind-title">${t("mind.title")}</h2>
        <intention-tree .insight=${insight}></intention-tree>
      </section>
      <section class="card senses" aria-labelledby="sensor-title">
        <h2 id="sensor-title">${t("sensor.title")}</h2>
        ${sensorPanel(insight.sensors, seen.loops)}
      </section>
      <section class="card believes" aria-labelledby="belief-title">
        <h2 id="belief-title">${t("mind.beliefs")} <span class="count">${seen.beliefs.length}</span></h2>
        ${beliefList(seen, insight.left_out.beliefs, this.beliefFilter, (filter) => (this.beliefFilter = filter))}
      </section>
      <section class="card trace" aria-labelledby="trace-title">
        <h2 id="trace-title">${t("mind.trace")}</h2>
        ${planTrace(seen, { text: this.traceFilter, kind: this.kind }, (change) => Object.assign(this, change))}
      </section>`;
  }

  #standing() {
    if (this.held !== null) return counted("mind.held", this.#run.seen.told - this.held);
    if (!this.online) return t("mind.offline");
    if (!this.tells) return t("mind.too_old");
    return t(this.seen.insight ? "mind.live" : "mind.waiting");
  }

  /** @param {Watched} watched */
  #take(watched) {
    if (watched.robot !== this.robot) return;
    this.tells = true; // whatever was thought of it while it was away
    this.#run.take(watched);
    if (this.held === null) this.seen = this.#run.seen;
    else this.requestUpdate();
  }

  #hold() {
    this.held = this.held === null ? this.#run.seen.told : null;
    this.seen = this.#run.seen;
  }

  async #say() {
    try {
      const watch = await api.watchRobot(this.robot, this.#run.isIncomplete);
      [this.tells, this.online, this.problem] = [watch.tells, watch.online, ""];
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }

  #download() {
    const file = document.createElement("a");
    file.href = URL.createObjectURL(new Blob([this.#run.asJsonLines()], { type: "application/jsonl" }));
    file.download = this.#run.fileName;
    file.click();
    setTimeout(() => URL.revokeObjectURL(file.href), 1_000);
  }
}

customElements.define("robot-diagnostics", RobotDiagnostics);
