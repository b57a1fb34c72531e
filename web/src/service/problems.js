/** Error messages, and the fields they belong to. */
import { ApiProblem, NoAnswer } from "./api.js";
import { hasText, t } from "../texts/texts.js";

/** Beside which field of an order it is said that the service does not take it. */
export const FIELD_OF_CODE = {
  unknown_post: "to_post",
  same_post: "to_post",
  no_way: "to_post",
  unknown_recipient: "recipient",
};

/** A sentence about any failure. @param {unknown} failure */
export function inWords(failure) {
  if (failure instanceof NoAnswer) return t(failure.isQuestion ? "error.not_loaded" : "error.no_answer");
  if (failure instanceof ApiProblem && hasText(`error.${failure.code}`)) return t(`error.${failure.code}`);
  return failure instanceof Error ? failure.message : String(failure);
}

/**
 * The same as `{field: sentence}`; "form" is the field of everything that belongs to none.
 * @param {unknown} failure @param {Record<string, string>} fieldOfCode @returns {Record<string, string>}
 */
export function atFields(failure, fieldOfCode) {
  if (!(failure instanceof ApiProblem)) return { form: inWords(failure) };
  const malformed = failure.fields.filter((field) => hasText(`error.malformed.${field}`));
  if (malformed.length) return Object.fromEntries(malformed.map((field) => [field, t(`error.malformed.${field}`)]));
  return { [fieldOfCode[failure.code] ?? "form"]: inWords(failure) };
}
