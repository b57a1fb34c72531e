/** Styles that come with a part of a page which comes later. */

/** Those of every page: what comes later stands behind them, and before the page's own. */
const EVERYWHERE = "/src/styles/everywhere.css";

/** @type {Map<string, Promise<unknown>>} */
const asked = new Map();

/** Fulfilled once they are there, as they are at once where the page's head has them; without them nothing waits for ever.
 *  @param {string} address */
export function withStyles(address) {
  const there = asked.get(address) ?? fetched(address);
  asked.set(address, there);
  return there;
}

/** @param {string} address */
async function fetched(address) {
  if (document.head.querySelector(`link[href="${address}"]`)) return;
  const link = Object.assign(document.createElement("link"), { rel: "stylesheet", href: address });
  const settled = new Promise((settle) => (link.onload = link.onerror = settle));
  document.head.querySelector(`link[href="${EVERYWHERE}"]`)?.after(link);
  await settled;
}
