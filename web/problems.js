/** What went wrong, in words, and beside which field to say it. */
import { ApiProblem, NoAnswer } from "./api.js";
import { hasText, t } from "./texts.js";

/** A sentence about any failure. @param {unknown} failure */
export function inWords(failure) {
  if (failure instanceof NoAnswer) return t("error.no_answer");
  if (failure instanceof ApiProblem && hasText(`error.${failure.code}`)) return t(`error.${failure.code}`);
  return failure instanceof Error ? failure.message : String(failure);
}

/**
 * The same as `{field: sentence}`; "form" is the field of everything that belongs to none.
 * @param {unknown} failure @param {Record<string, string>} fieldOfCode
 */
export function atFields(failure, fieldOfCode) {
  const field = failure instanceof ApiProblem ? fieldOfCode[failure.code] : undefined;
  return { [field ?? "form"]: inWords(failure) };
}
