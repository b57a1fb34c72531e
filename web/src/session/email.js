/** Checks email addresses as the browser's own fields do. */

const judge = Object.assign(document.createElement("input"), { type: "email" });

/** @param {string} text */
export function looksLikeEmail(text) {
  judge.value = text;
  return text !== "" && !judge.validity.typeMismatch;
}
