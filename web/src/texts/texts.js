/** The words of the pages: one catalogue per language, chosen once per page. */

/** @type {Record<string, string>} */
let catalogue = {};

/** The language of the catalogue, "en" before any is loaded. */
let language = "en";

/**
 * The first wanted language that there is, "fr-CA" counting as "fr"; else the first there is.
 * @param {readonly string[]} wanted @param {readonly string[]} known
 */
export function chooseLanguage(wanted, known) {
  const plain = wanted.map((tag) => tag.toLowerCase().split("-")[0]);
  return plain.find((tag) => known.includes(tag)) ?? known[0] ?? "en";
}

/** Each is asked for once per page. @type {Map<string, Promise<Record<string, string>>>} */
const asked = new Map();

/** @param {string} wanted */
export function fetchTexts(wanted) {
  const texts = asked.get(wanted) ?? fetched(wanted);
  asked.set(wanted, texts);
  return texts;
}

/** Which pages fetch more than the everyday ones need: some a part (app/http/page_files.py says which), some all texts.
 *  @type {Record<string, string>} */
const TEXTS_OF = { "/mailroom.html": ".mailroom", "/robots.html": "", "/print.html": "", "/settings.html": "" };

/** @param {string} wanted @returns {Promise<Record<string, string>>} */
async function fetched(wanted) {
  const answer = await fetch(`/src/texts/${wanted}${TEXTS_OF[location.pathname] ?? ".everyday"}.json`);
  if (!answer.ok) throw new Error(`no texts for ${wanted}`);
  return answer.json();
}

/** @param {string} wanted */
export async function loadTexts(wanted) {
  catalogue = await fetchTexts(wanted);
  language = wanted;
  document.documentElement.lang = wanted;
}

/** The locale of times and numbers: the catalogue's, by which mails are written too (app/core/texts/times.py). */
export const locale = () => catalogue["time.locale"] ?? language;

/** @param {string} key */
export const hasText = (key) => key in catalogue;

/**
 * The text of a key, with {names} replaced. A missing key shows itself: it is a mistake to be seen.
 * @param {string} key @param {Record<string, string | number>} [values]
 */
export const t = (key, values = {}) =>
  (catalogue[key] ?? key).replace(/\{(\w+)\}/g, (whole, name) => isolated(`${values[name] ?? whole}`));

const RIGHT_TO_LEFT = /[\u0590-\u08ff\ufb1d-\ufdff\ufe70-\ufefc\u{10800}-\u{10fff}\u{1e800}-\u{1efff}]/u;

/** Words that run from right to left, kept from turning round what stands beside them; where there is an element for them,
 *  it is a <bdi>. @param {string} words */
export const isolated = (words) => (RIGHT_TO_LEFT.test(words) ? `\u2068${words}\u2069` : words);

/** A text that has ".one" and ".other" forms. @param {string} key @param {number} count */
export const counted = (key, count) =>
  t(`${key}.${new Intl.PluralRules(language).select(count) === "one" ? "one" : "other"}`, { count });
