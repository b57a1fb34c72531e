/** Alarm messages in this page's language. */
import { inEnglish, reasonText } from "./reason_words.js";
import { hasText, t } from "./texts.js";
/** @import { Alarm, CampusMap } from "../../types/api_types.ts" */

/** As it was said if the catalogue has it, else what its name says and, in English, how the robot put it. @param {Alarm} alarm @param {CampusMap | null} map */
export function alarmText({ name, reason, why_words }, map) {
  const known = `why.fault.${name}`;
  if (why_words || !hasText(known)) return reasonText(reason, why_words, map);
  return t("alarm.and_it_says", { what: t(known), said: inEnglish(reason) });
}

/** The same for everybody's eyes: of what the catalogue knows nothing that was said besides. @param {Alarm} alarm @param {CampusMap | null} map */
export function alarmTextForAll(alarm, map) {
  const known = `why.fault.${alarm.name}`;
  return !alarm.why_words && hasText(known) ? t(known) : alarmText(alarm, map);
}
