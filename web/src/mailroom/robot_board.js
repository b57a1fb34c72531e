/** A list of the robots, with the state of each and its commands. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { alarmText } from "../texts/alarm_words.js";
import { canReleaseCorridors, takeOut } from "./corridor_actions.js";
import { robotPage } from "../service/links.js";
import { openWays, pause, recall, resume, stop } from "./mailroom_actions.js";
import { isHeldUp } from "./mailroom_words.js";
import { batteryText, robotWhy } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago } from "../texts/times.js";
import { icon } from "../elements/icon.js";
/** @import { Alarm, CampusMap, Robot } from "../../types/api_types.ts" */
/** @import { Action } from "./mailroom_actions.js" */
/** @import { Doing } from "./issue_list.js" */

const LOW_RATIO = 0.25;

/**
 * @param {Robot[]} robots @param {Alarm[]} alarms @param {CampusMap} map
 * @param {(Doing & {isAskedToWait: (robot: string) => boolean}) | null} doing null: on a wall
 */
export function robotBoard(robots, alarms, map, doing) {
  if (!robots.length) return html`<p class="empty">${t("mailroom.robots.none")}</p>`;
  return html`<ul class="board">
    ${repeat(robots, ({ name }) => name, (robot) => html`<li class=${isHeldUp(robot) ? "held-up" : nothing}>
      <div class="head">
        <h3>${doing ? html`<a href=${robotPage(robot.name)}>${t("robot.name", { name: robot.name })}</a>` : t("robot.name", { name: robot.name })}</h3>
        ${state(robot)} ${charge(robot)}
      </div>
      <p><bdi>${why(robot, map)}</bdi></p>
      <p class="hint">${whereSeen(robot, map)}</p>
      ${seenTo(robot, alarms, map)} ${doing ? buttons(robot, alarms, map, doing) : nothing}
    </li>`)}
  </ul>`;
}

/** @param {Robot} robot */
function state({ activity, online }) {
  if (!online) return html`<span class="badge away">${icon("network")}${t("mailroom.robots.no_network")}</span>`;
  return html`<span class="badge ${activity}">${t(`mailroom.activity.${activity}`)}</span>`;
}

/** @param {Robot} robot */
function charge({ battery }) {
  if (!battery) return nothing;
  const words = batteryText(battery);
  const low = battery.ratio < LOW_RATIO && !battery.charging;
  return html`<span class=${low ? "charge low" : "charge"}>${icon("battery")}<span>${words}</span></span>`;
}

/** @param {Robot} robot @param {CampusMap} map */
function why(robot, map) {
  const { why, activity, towards } = robot;
  if (why) return robotWhy(robot, map);
  return activity === "driving" && towards ? t("map.towards", { post: titleOf(map, towards) }) : t(`mailroom.activity.${activity}`);
}

/** @param {Robot} robot @param {CampusMap} map */
function whereSeen({ last_seen, online, heard_at }, map) {
  const now_ms = serverNow();
  const seen = last_seen ? t("map.seen", { post: titleOf(map, last_seen.post), ago: ago(last_seen.at, now_ms) }) : t("map.never_seen");
  return online || !heard_at ? seen : `${seen} · ${t("mailroom.robots.heard", { ago: ago(heard_at, now_ms) })}`;
}

/** Acknowledged alarms. @param {Robot} robot @param {Alarm[]} alarms */
const ofRobot = ({ name }, alarms) => alarms.filter(({ robot, acknowledged_at }) => robot === name && acknowledged_at);

/** @param {Robot} robot @param {Alarm[]} alarms @param {CampusMap} map */
function seenTo(robot, alarms, map) {
  const theirs = ofRobot(robot, alarms).map((alarm) => alarmText(alarm, map));
  return theirs.length ? html`<p class="hint">${icon("check")}${t("alarm.seen_to", { alarms: theirs.join("; ").replaceAll(".;", ";") })}</p>` : nothing;
}

/** @param {Robot} robot @param {Alarm[]} alarms @param {CampusMap} map @param {Doing & {isAskedToWait: (robot: string) => boolean}} doing */
function buttons(robot, alarms, map, doing) {
  const waits = isHeldUp(robot) || doing.isAskedToWait(robot.name);
  const ways = ofRobot(robot, alarms).flatMap((alarm) => openWays(alarm, map));
  /** @param {Action} action @param {string} look */
  const button = (action, look, said = t(`mailroom.do.${action.name}`)) => html`<button type="button" class=${look}
    @click=${() => doing.ask(action, robot.name)}>${said}<span class="unseen">: ${robot.name}</span></button>`;
  return html`<div class="commands">
    ${button(waits ? resume(robot) : pause(robot), "")} ${button(recall(robot), "")} ${button(stop(robot), "stop")}
    ${canReleaseCorridors(robot) ? button(takeOut(robot.name), "") : nothing}
    ${ways.map((way) => button(way, "", t("mailroom.do.open_way.which", way.names)))}
  </div>`;
}
