/** Modules that are fetched when they are wanted, and again where that failed: many browsers remember the failure. */

/** How often each could not be fetched, by its address. @type {Map<string, number>} */
const failures = new Map();

/**
 * The module, under another address each time after it could not be fetched.
 * @template M
 * @param {() => Promise<M>} load imports it
 * @param {string} address of the same module
 * @returns {Promise<M>}
 */
export async function fetched(load, address) {
  const failed = failures.get(address) ?? 0;
  try {
    return await (failed ? import(`${address}?again=${failed}`) : load());
  } catch (error) {
    failures.set(address, failed + 1);
    throw error;
  }
}
