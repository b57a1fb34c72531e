/** Commands of a dispatcher to a robot, and its answers to the latest. */
import { html, nothing } from "lit";
import { alarmText } from "../texts/alarm_words.js";
import * as api from "../service/api.js";
import { canReleaseCorridors, takeOut } from "../mailroom/corridor_actions.js";
import { openWays, pause, recall, resume, stop } from "../mailroom/mailroom_actions.js";
import { inWords } from "../service/problems.js";
import { reasonText } from "../texts/reason_words.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago } from "../texts/times.js";
import "../elements/ask_dialog.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { Alarm, CampusMap, Command, Robot } from "../../types/api_types.ts" */
/** @import { AskDialog } from "../elements/ask_dialog.js" */
/** @import { Action } from "../mailroom/mailroom_actions.js" */

const SHOWN = 8;

export class RobotCommands extends PageElement {
  static properties = {
    robot: { attribute: false },
    map: { attribute: false },
    may: { type: Boolean },
    commands: { state: true },
    closed: { state: true },
    problem: { state: true },
  };

  constructor() {
    super();
    /** @type {Robot | null} */
    this.robot = null;
    /** @type {CampusMap | null} */
    this.map = null;
    /** True if this person may send commands. */
    this.may = false;
    /** @type {Command[]} */
    this.commands = [];
    /** Corridors that it found closed. @type {Alarm[]} */
    this.closed = [];
    this.problem = "";
  }

  /** A robot that says something may have answered. @param {Map<string, unknown>} changed */
  updated(changed) {
    if (changed.has("robot") && this.robot) this.#fetch(this.robot.name);
  }

  render() {
    const { robot } = this;
    if (!robot) return nothing;
    return html`${this.may && this.map ? this.#closedWays(this.map) : nothing} ${this.may ? this.#buttons(robot) : html`<p class="hint">${t("robots.dispatchers_tell")}</p>`}
      ${this.problem ? problemLine(this.problem) : nothing}
      ${this.commands.length
        ? html`<h3>${t("robots.told")}</h3>
            <ul class="told">${this.commands.map((command) => toldLine(command, this.map))}</ul>`
        : nothing}
      <ask-dialog @done=${() => this.#fetch(robot.name)}></ask-dialog>`;
  }

  /** @param {Robot} robot */
  #buttons(robot) {
    /** @param {Action} action */
    const button = (action) => html`<button type="button" class=${action.danger ? "danger" : ""} @click=${() => this.#ask(action)}>
      ${t(`mailroom.do.${action.name}`)}
    </button>`;
    const told = [pause(robot), resume(robot), recall(robot), stop(robot)];
    return html`<div class="choices">${[...told, ...(canReleaseCorridors(robot) ? [takeOut(robot.name)] : [])].map(button)}</div>`;
  }

  /** @param {CampusMap} map */
  #closedWays(map) {
    const ways = this.closed.flatMap((alarm) => openWays(alarm, map).map((way) => ({ alarm, way })));
    if (!ways.length) return nothing;
    return html`<ul class="closed-ways">${ways.map(({ alarm, way }) => html`<li>
      <span>${alarmText(alarm, map)}</span>
      <button type="button" @click=${() => this.#ask(way)}>${t(`mailroom.do.${way.name}`)}</button>
    </li>`)}</ul>`;
  }

  /** @param {Action} action */
  #ask(action) {
    const dialog = /** @type {AskDialog} */ (this.querySelector("ask-dialog"));
    dialog.ask([action], t("robot.name", { name: this.robot?.name ?? "" }));
  }

  /** @param {string} name */
  async #fetch(name) {
    try {
      const [commands, alarms] = await Promise.all([
        api.robotCommands(name, { limit: SHOWN }),
        api.robotAlarms(name, { only_open: "true", limit: SHOWN }),
      ]);
      [this.commands, this.closed] = [commands.items, alarms.items.filter(({ corridor }) => corridor)];
      this.problem = "";
    } catch (failure) {
      this.problem = inWords(failure);
    }
  }
}

/** @param {Command} command @param {CampusMap | null} map */
function toldLine({ kind, asked_at, accepted, reason, reason_words, online }, map) {
  const answer = accepted === null ? (online ? "waits" : "has_not_heard") : accepted ? "did" : "refused";
  return html`<li class=${answer}>
    <strong>${t(`robots.command.${kind}`)}</strong>
    <span>${t(`robots.answer.${answer}`)}${reason ? html`: <bdi>${reasonText(reason, reason_words, map)}</bdi>` : nothing}</span>
    <time datetime=${asked_at}>${ago(asked_at, serverNow())}</time>
  </li>`;
}

customElements.define("robot-commands", RobotCommands);
