/** Whether somebody is told how it goes: on asking, and without as long as they have sent nothing and not put it away. */

const PUT_AWAY = "first-steps-put-away";

/** @param {boolean} isNew */
export const wantsFirstHelp = (isNew) =>
  new URLSearchParams(location.search).has("help") || (isNew && localStorage.getItem(PUT_AWAY) === null);

/** Never again by itself. */
export function putFirstHelpAway() {
  localStorage.setItem(PUT_AWAY, "yes");
  const here = new URL(location.href);
  here.searchParams.delete("help");
  history.replaceState(history.state, "", here);
}
