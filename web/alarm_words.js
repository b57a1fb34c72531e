/** What an alarm says, in this page's language. */
import { titleOf } from "./posts.js";
import { hasText, t } from "./texts.js";
/** @import { Alarm, CampusMap, Words } from "./api_types.ts" */

const POSTS = ["post", "from", "to"];

/** As it was said if the catalogue has it, else what its name says and, in English, how the robot put it. @param {Alarm} alarm @param {CampusMap | null} map */
export function alarmText({ name, reason, why_words }, map) {
  if (why_words && hasText(why_words.key)) return t(why_words.key, filled(why_words.facts, map));
  const known = `why.fault.${name}`;
  return hasText(known) ? t("alarm.and_it_says", { what: t(known), said: quoted(reason) }) : quoted(reason);
}

/** The same for everybody's eyes: of what the catalogue knows nothing that was said besides. @param {Alarm} alarm @param {CampusMap | null} map */
export function alarmTextForAll(alarm, map) {
  const known = `why.fault.${alarm.name}`;
  return !alarm.why_words && hasText(known) ? t(known) : alarmText(alarm, map);
}

/** @param {string} sentence */
const quoted = (sentence) => t("why.in_english", { sentence });

/** Posts by their titles; what a robot's program has said of its own stays English. @param {Words["facts"]} facts @param {CampusMap | null} map */
const filled = (facts, map) =>
  Object.fromEntries(
    Object.entries(facts).map(([name, fact]) => {
      if (name === "reason") return [name, quoted(fact)];
      return [name, map && POSTS.includes(name) ? titleOf(map, fact) : fact];
    }),
  );
