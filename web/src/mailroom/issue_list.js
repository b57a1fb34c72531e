/** Issues that need a dispatcher, each with its next action as a button. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { alarmText, alarmTextForAll } from "../texts/alarm_words.js";
import { takeOut } from "./corridor_actions.js";
import { followPage, robotPage } from "../service/links.js";
import { openWays, release, resolve, resume } from "./mailroom_actions.js";
import { orderTitle, orderWay, since, withoutOwnWords } from "./mailroom_words.js";
import { orderReason, robotWhy } from "../orders/order_words.js";
import { titleOf } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { ago } from "../texts/times.js";
import { icon } from "../elements/icon.js";
/** @import { Alarm, CampusMap, Order, Robot, Sending } from "../../types/api_types.ts" */
/** @import { Action } from "./mailroom_actions.js" */
/** @import { Issue } from "./mailroom_words.js" */

/**
 * The callbacks of the buttons.
 * @typedef {object} Doing
 * @property {(action: Action, about: string) => void} ask
 * @property {(alarm: Alarm) => void} acknowledge
 * @property {(sending: Sending) => void} sendAgain
 */

/** @param {Issue[]} issues @param {CampusMap} map @param {Doing | null} doing null: on a wall, where nothing can be done */
export function issueList(issues, map, doing) {
  if (!issues.length) return html`<p class="all-well">${icon("check")}${t("mailroom.wrong.none")}</p>`;
  return html`<ul class="issues">
    ${repeat(issues, ({ key }) => key, (wrong) => html`<li class=${wrong.kind}>${icon("warning")}${row(wrong, map, doing)}</li>`)}
  </ul>`;
}

/** @param {Issue} wrong @param {CampusMap} map @param {Doing | null} doing */
function row(wrong, map, doing) {
  if (wrong.kind === "alarm") return ofAlarm(wrong.alarm, map, doing);
  if (wrong.kind === "attention") return ofOrder(wrong.order, map, doing);
  if (wrong.kind === "locked") return ofLocked(wrong.order, map, doing);
  if (wrong.kind === "given_up") return ofSending(wrong.sending, doing);
  return ofRobot(wrong.kind, wrong.robot, map, doing);
}

/** @param {string} what @param {string} more @param {string | null} at @param {unknown} action */
const line = (what, more, at, action) => html`<div class="what">
    <strong>${what}</strong>
    <span><bdi>${more}</bdi>${at ? html` <small>${ago(at, serverNow())}</small>` : nothing}</span>
  </div>
  ${action}`;

/** @param {string} text @param {string} about for screen readers, which may read the button alone @param {() => void} press */
const button = (text, about, press) =>
  html`<button type="button" @click=${press}>${text}<span class="unseen">: ${about}</span></button>`;

/** @param {Action} way */
const betweenEnds = ({ names = {} }) => `${names.from} – ${names.to}`;

/** @param {Alarm} alarm @param {CampusMap} map @param {Doing | null} doing */
function ofAlarm(alarm, map, doing) {
  const name = t("robot.name", { name: alarm.robot });
  const what = alarm.post ? t("mailroom.wrong.alarm", { robot: name, post: titleOf(map, alarm.post) }) : name;
  return line(what, (doing ? alarmText : alarmTextForAll)(alarm, map), alarm.at, doing && html`<div class="ways-out">
    ${alarm.name === "vanished" ? button(t("mailroom.do.take_out"), what, () => doing.ask(takeOut(alarm.robot), what)) : nothing}
    ${openWays(alarm, map).map((way) => button(t(`mailroom.do.${way.name}`), betweenEnds(way), () => doing.ask(way, what)))}
    ${button(t("alarm.acknowledge"), what, () => doing.acknowledge(alarm))}
  </div>`);
}

/** @param {Order} order @param {CampusMap} map @param {Doing | null} doing */
function ofOrder(order, map, doing) {
  const what = t("mailroom.wrong.attention", { way: orderWay(order, map) });
  const shown = doing ? order : withoutOwnWords(order);
  const why = shown.why ? orderReason(shown, map) : "";
  const more = doing ? t("mailroom.wrong.who_why", { order: orderTitle(order), why }) : why;
  return line(what, more, since(order), doing && [
    html`<a class="button quiet" href=${followPage(order.id)}>${t("mailroom.look")}<span class="unseen">: ${orderTitle(order)}</span></a>`,
    button(t("mailroom.do.resolve"), orderTitle(order), () => doing.ask(resolve(order), orderTitle(order))),
  ]);
}

/** @param {Order} order @param {CampusMap} map @param {Doing | null} doing */
function ofLocked(order, map, doing) {
  const what = t("mailroom.wrong.locked", { way: orderWay(order, map) });
  return line(what, doing ? t("mailroom.wrong.locked_why") : "", null,
    doing && button(t("mailroom.do.release"), orderTitle(order), () => doing.ask(release(order), orderTitle(order))));
}

/** @param {"stopped" | "silent"} kind @param {Robot} robot @param {CampusMap} map @param {Doing | null} doing */
function ofRobot(kind, robot, map, doing) {
  const what = t(`mailroom.wrong.${kind}`, { robot: robot.name });
  const where = robot.last_seen ? t("map.seen", { post: titleOf(map, robot.last_seen.post), ago: ago(robot.last_seen.at, serverNow()) }) : "";
  const more = kind === "stopped" && robot.why ? robotWhy(robot, map) : where;
  return line(what, more, kind === "silent" ? robot.heard_at : null, doing && [
    html`<a class="button quiet" href=${robotPage(robot.name)}>${t("mailroom.look")}<span class="unseen">: ${robot.name}</span></a>`,
    kind === "stopped" ? button(t("mailroom.do.go_on"), robot.name, () => doing.ask(resume(robot), robot.name)) : nothing,
  ]);
}

/** @param {Sending} sending @param {Doing | null} doing */
function ofSending(sending, doing) {
  const what = t("mailroom.wrong.given_up", { channel: t(`mailroom.channel.${sending.channel}`) });
  const more = doing ? t("mailroom.wrong.to_whom", { email: sending.email, problem: sending.problem ?? "" }) : "";
  return line(what, more, sending.gave_up_at, doing && button(t("mailroom.retry"), sending.email, () => doing.sendAgain(sending)));
}
