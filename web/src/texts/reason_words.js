/**
 * Reasons in this page's language: sentences and codes that the service has recognised, with what fills their gaps
 * (app/core/texts/reasons.py says the same in mails).
 * @import { CampusMap, Words } from "../../types/api_types.ts"
 */
import { titleOf } from "../service/posts.js";
import { hasText, t } from "./texts.js";

const POSTS = ["post", "from", "to"];
/** A code is no sentence: it stands in one, or alone. */
const ALONE = /^gap\.|^why\.own_code$/;

/**
 * Why something is as it is; a sentence that the catalogue does not have is shown as it was said.
 * @param {string} said @param {Words | null} words @param {CampusMap | null} map
 */
export function reasonText(said, words, map) {
  if (!words || !hasText(words.key)) return inEnglish(said);
  const text = t(words.key, filled(words.facts, map));
  return ALONE.test(words.key) ? text[0].toUpperCase() + text.slice(1) : text;
}

/** @param {string} sentence */
export const inEnglish = (sentence) => t("why.in_english", { sentence });

/** @param {Words["facts"]} facts @param {CampusMap | null} map */
const filled = (facts, map) =>
  Object.fromEntries(Object.entries(facts).map(([gap, fact]) => [gap, filling(gap, fact, map)]));

/** Codes in words, posts by their titles; what a robot's program has said of its own stays English. @param {string} gap @param {string} fact @param {CampusMap | null} map */
function filling(gap, fact, map) {
  const key = [`gap.${gap}.${fact}`, ...(gap === "reason" ? [`why.fault.${fact}`] : [])].find(hasText);
  if (key) return t(key).replace(/\.$/, "");
  if (gap === "reason") return inEnglish(fact);
  return map && POSTS.includes(gap) ? titleOf(map, fact) : fact;
}
