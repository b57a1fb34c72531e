/** The end of the order form, fetched at the first input: says what is missing, or places the order. */
import * as api from "../service/api.js";
import { looksLikeEmail } from "../session/email.js";
import { followPage, PAGES } from "../service/links.js";
import { Kept, placeOrder } from "./place_order.js";
import { atFields, FIELD_OF_CODE } from "../service/problems.js";
import { personHere } from "../session/session.js";
import { t } from "../texts/texts.js";
/** @import { WantedOrder } from "../../types/api_types.ts" */
/** @import { Schedule, When } from "./order_schedule.js" */
/** @typedef {{wanted: WantedOrder, when: When, schedule: Schedule}} FilledIn */
/** The page that shows it, or that it is kept on this device, or why it was not taken. @typedef {{page?: string, kept?: boolean, problems?: Record<string, string>}} Sent */

/** @param {FilledIn} filled @returns {Promise<Sent>} */
export async function sendOrder(filled) {
  const problems = missing(filled);
  if (Object.keys(problems).length) return { problems };
  try {
    return { page: await place(filled) };
  } catch (failure) {
    return failure instanceof Kept ? { kept: true } : { problems: atFields(failure, FIELD_OF_CODE) };
  }
}

/** Where it is followed. @param {FilledIn} filled @returns {Promise<string>} */
async function place({ wanted, when, schedule }) {
  const { weekdays = [], at = "", zone = "", until, not_before } = schedule;
  if (when === "again") {
    const { not_before: _, ...always } = wanted;
    await api.placeStandingOrder({ ...always, weekdays, at, zone, until });
    return PAGES.mail;
  }
  const once = { ...wanted, not_before: when === "later" ? not_before : undefined };
  return followPage((await placeOrder(once, personHere()?.id ?? "")).id);
}

/** Check the fields that a person can correct at once; everything else is the service's to judge.
 *  @param {FilledIn} filled @returns {Record<string, string>} */
function missing({ wanted: { from_post, to_post, recipient }, when, schedule }) {
  return {
    ...(from_post ? {} : { from_post: t("error.missing_from_post") }),
    ...(to_post ? {} : { to_post: t("error.missing_to_post") }),
    ...(recipient ? {} : { recipient: t("error.missing_recipient") }),
    ...(recipient && !looksLikeEmail(recipient) ? { recipient: t("error.malformed.recipient") } : {}),
    ...(isScheduled(when, schedule) ? {} : { when: t("error.missing_when") }),
  };
}

/** @param {When} when @param {Schedule} schedule */
const isScheduled = (when, { not_before, weekdays, at }) =>
  when === "now" || (when === "later" ? Boolean(not_before) : Boolean(weekdays?.length && at));
