/** Past events of an order with their times, and the events to come. */
import { html, nothing } from "lit";
import { eventReason, timeline } from "../orders/order_words.js";
import { serverNow } from "../service/server_clock.js";
import { isolated, t } from "../texts/texts.js";
import { clockTime, dayAndTime } from "../texts/times.js";
/** @import { CampusMap, Order, OrderEvent } from "../../types/api_types.ts" */

const REPORTED_LATE_MS = 30_000;

/** @param {Order} order @param {CampusMap} map */
export function orderTimeline(order, map) {
  const entries = timeline(order, map);
  const latest = entries.findLastIndex(({ event }) => event?.kind === "moved");
  return html`<ol class="timeline">
    ${entries.map(({ text, event }, i) => {
      const time = event && (event.robot_at ?? event.at);
      return html`<li class=${i === latest ? "now" : event ? "past" : "ahead"} aria-current=${i === latest ? "step" : nothing}>
        <div>
          <span class="what">${text}${event ? nothing : html`<span class="unseen">, ${t("timeline.later")}</span>`}</span>
          ${event ? remarks(event, map) : nothing}
        </div>
        ${time ? html`<time datetime=${time}>${dayAndTime(time, serverNow())}</time>` : nothing}
      </li>`;
    })}
  </ol>`;
}

/** @param {OrderEvent} event @param {CampusMap} map */
function remarks(event, map) {
  const { at, robot_at } = event;
  const late = robot_at !== null && Date.parse(at) - Date.parse(robot_at) > REPORTED_LATE_MS;
  const told = [isolated(eventReason(event, map) ?? ""), late && t("timeline.told_later", { time: clockTime(at) })].filter(Boolean);
  return told.length ? html`<span class="remark">${told.join(" · ")}</span>` : nothing;
}
