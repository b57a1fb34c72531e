/** What is known of a robot, as a list: everything that the map shows, and why it waits. */
import { html, nothing } from "lit";
import { reasonText } from "../order_words.js";
import { titleOf } from "../posts.js";
import { serverNow } from "../server_clock.js";
import { t } from "../texts.js";
import { ago, percent, windowText } from "../times.js";
import { icon } from "./icon.js";
/** @import { CampusMap, Robot } from "../api_types.ts" */

/** @param {CampusMap} map @param {Robot | null} robot @param {string} from @param {string} to */
export function robotFacts(map, robot, from, to) {
  return html`<ul class="facts">
    ${robot ? aboutRobot(map, robot) : fact("robot", t("map.no_robot"))}
    ${fact("arrow", t("map.from_fact", { post: titleOf(map, from) }))}
    ${fact("pin", t("map.to_fact", { post: titleOf(map, to) }))}
  </ul>`;
}

/** @param {CampusMap} map @param {Robot} robot */
function aboutRobot(map, { last_seen, expected, towards, battery, online, heard_at, activity, why, why_words }) {
  const now_ms = serverNow();
  return [
    fact(
      "robot",
      last_seen ? t("map.seen", { post: titleOf(map, last_seen.post), ago: ago(last_seen.at, now_ms) }) : t("map.never_seen"),
    ),
    expected
      ? fact("clock", t("map.expected", { post: titleOf(map, expected.post), window: windowText(expected) }))
      : towards && activity === "driving"
        ? fact("clock", t("map.towards", { post: titleOf(map, towards) }))
        : nothing,
    why && activity === "driving" ? fact("send", reasonText(why, why_words, map)) : nothing,
    online || !heard_at ? nothing : fact("network", t("robot.offline", { ago: ago(heard_at, now_ms) })),
    battery
      ? fact("battery", t(battery.charging ? "robot.charging" : "robot.battery", { charge: percent(battery.ratio) }))
      : nothing,
  ];
}

/** @param {Parameters<typeof icon>[0]} drawing @param {string} text */
const fact = (drawing, text) => html`<li>${icon(drawing)}<span>${text}</span></li>`;
