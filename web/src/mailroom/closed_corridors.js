/** The corridors into which no robot is let, and how that is changed. */
import { html, nothing } from "lit";
import { repeat } from "lit-html/directives/repeat.js";
import { closeOne, openAgain } from "./corridor_actions.js";
import { corridorTitle } from "../service/posts.js";
import { serverNow } from "../service/server_clock.js";
import { hasText, t } from "../texts/texts.js";
import { ago } from "../texts/times.js";
import { icon } from "../elements/icon.js";
/** @import { CampusMap, ClosedCorridor } from "../../types/api_types.ts" */
/** @import { Doing } from "./issue_list.js" */

/** @param {readonly ClosedCorridor[]} closed @param {CampusMap} map @param {Pick<Doing, "ask"> | null} doing null: where nothing can be done */
export function closedCorridors(closed, map, doing) {
  return html`${closed.length
      ? html`<ul class="shut-corridors">${repeat(closed, ({ corridor }) => corridor, (one) => html`<li>${row(one, map, doing)}</li>`)}</ul>`
      : html`<p class="empty">${t("corridors.none")}</p>`}
    ${doing
      ? html`<button type="button" @click=${() => doing.ask(closeOne(map, closed), t("corridors.title"))}>${t("mailroom.do.close_corridor")}</button>`
      : nothing}`;
}

/** @param {ClosedCorridor} closed @param {CampusMap} map @param {Pick<Doing, "ask"> | null} doing */
function row(closed, map, doing) {
  const name = corridorTitle(map, closed.corridor);
  return html`${icon("corridor")}
    <div class="what">
      <strong>${name}</strong>
      <span><bdi>${why(closed)}</bdi> <small>${ago(closed.closed_at, serverNow())}</small></span>
    </div>
    ${doing
      ? html`<button type="button" @click=${() => doing.ask(openAgain(map, closed), name)}>${t("mailroom.do.reopen")}<span
          class="unseen">: ${name}</span></button>`
      : nothing}`;
}

const TURNED_BACK = "alarm.of.turned_back.";

/** A person's reason as it was typed; what robots met there in this page's language. @param {ClosedCorridor} closed */
function why({ by_person, reason, why_words, robots }) {
  const names = { reason, robots: robots.map((name) => t("robot.name", { name })).join(", ") };
  if (by_person) return robots.length ? t("corridors.also_found", names) : reason;
  const known = `corridors.found.${why_words?.key.replace(TURNED_BACK, "")}`;
  return t(hasText(known) ? known : "corridors.found", names);
}
