/**
 * The mailroom on a wall: for eyes alone, from afar. Nothing to press, nothing that turns over, and of people no more
 * than passers-by may read.
 */
import { html, nothing } from "lit";
import { expectedWithOrders } from "../orders/arrival.js";
import { Closures } from "../live/closures.js";
import { PAGES } from "../service/links.js";
import { fetchMap } from "../map/map_later.js";
import { MailroomNow } from "./mailroom_now.js";
import { shortName, sorted, openIssues, withoutOwnWords } from "./mailroom_words.js";
import { serverNow } from "../service/server_clock.js";
import { t } from "../texts/texts.js";
import { Ticking } from "../elements/ticking.js";
import { clockTime } from "../texts/times.js";
import { TrafficNow } from "../live/traffic.js";
import { StaysAwake } from "../elements/stays_awake.js";
import { problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
import { queueList } from "./queue_list.js";
import { robotBoard } from "./robot_board.js";
import { issueList } from "./issue_list.js";
/** @import { Order } from "../../types/api_types.ts" */

/** So many fit on a screen of 1080 lines beside everything that can be wrong. */
const SHOWN = 8;

export class MailroomWall extends PageElement {
  now = new MailroomNow(this);
  traffic = new TrafficNow(this);
  corridors = new Closures(this);

  constructor() {
    super();
    new Ticking(this);
    new StaysAwake(this);
  }

  firstUpdated() {
    fetchMap();
  }

  render() {
    const { map, problem, known } = this.now;
    if (!map) return problem ? html`<h1>${t("mailroom.title")}</h1>${problemLine(problem)}` : html`<p class="waiting" role="status">${t("app.loading")}</p>`;
    const orders = sorted(known.orders, "waiting", map);
    const unseen = orders.length - SHOWN;
    return html`<div class="wall-head">
        <h1>${map.title}</h1>
        <a class="button quiet" href=${PAGES.mailroom}>${t("mailroom.wall.leave")}</a>
        <time>${clockTime(new Date(serverNow()).toISOString())}</time>
      </div>
      ${problem ? problemLine(problem) : nothing}
      ${issueList(openIssues(known), map, null)}
      <div class="wall-columns">
        <section aria-labelledby="queue-title">
          <h2 id="queue-title">${t("mailroom.queue")} <span class="count">${orders.length}</span></h2>
          ${orders.length ? queueList(orders.slice(0, SHOWN).map(withoutOwnWords), map, whoseShort, null) : html`<p class="empty">${t("mailroom.queue_empty")}</p>`}
          ${unseen > 0 ? html`<p class="hint">${t("mailroom.wall.more", { count: unseen })}</p>` : nothing}
        </section>
        <section aria-labelledby="robots-title">
          <h2 id="robots-title">${t("mailroom.robots")}</h2>
          ${robotBoard(known.robots, [], map, null)}
        </section>
        <section aria-labelledby="map-title">
          <h2 id="map-title">${t("mailroom.map")}</h2>
          <campus-map .map=${map} .robots=${expectedWithOrders(known.robots, known.orders, serverNow())} .traffic=${this.traffic.taken} .reported=${this.traffic.reported} .alarms=${known.alarms}
            .closed=${this.corridors.closed}></campus-map>
        </section>
      </div>`;
  }
}

/** @param {Order} order */
const whoseShort = ({ sender, recipient }) =>
  t("mailroom.order", { sender: shortName(sender.name), recipient: shortName(recipient.name) });

customElements.define("mailroom-wall", MailroomWall);
