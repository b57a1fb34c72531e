/** Parts of a followed order that few people open, fetched when they do. */
import { fetched } from "../service/fetched_again.js";

export const loadDigits = () => fetched(() => import("./digits_entry.js"), import.meta.resolve("./digits_entry.js"));
export const loadDelegates = () => fetched(() => import("./order_delegates.js"), import.meta.resolve("./order_delegates.js"));
