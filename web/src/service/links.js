/**
 * Where each page is, and who may open it.
 * @import { Order, Person, WantedOrder } from "../../types/api_types.ts"
 * @typedef {keyof typeof PAGES | "follow" | "print"} PageName what `title.NAME` is the title of
 */

export const PAGES = {
  order: "/",
  mail: "/mail.html",
  notices: "/notices.html",
  mailroom: "/mailroom.html",
  robots: "/robots.html",
  settings: "/settings.html",
};

/** One of these roles opens the page; every other page is for all signed-in persons. @type {Partial<Record<PageName, Person["roles"]>>} */
const NEEDED = {
  mailroom: ["dispatcher"],
  print: ["dispatcher"],
  robots: ["maintainer", "dispatcher"],
};

/** @param {PageName} page @param {Person} person */
export const mayOpen = (page, person) => NEEDED[page]?.some((role) => person.roles.includes(role)) ?? true;

/** The page of one robot. @param {string} name */
export const robotPage = (name) => `/robots.html?robot=${encodeURIComponent(name)}`;

/** The marker sheets for the printer; the mailroom for everybody to see. */
export const PRINT_PAGE = "/print.html";
export const WALL_PAGE = "/mailroom.html?wall";

/** A slip to go with the mail of one order. @param {string} order_id */
export const slipPage = (order_id) => `${PRINT_PAGE}?order=${encodeURIComponent(order_id)}`;

/** @param {string} order_id */
export const followPage = (order_id) => `/follow.html?order=${encodeURIComponent(order_id)}`;

/** The order page, filled in like an earlier order. @param {Order} order */
export const repeatPage = (order) =>
  "/?" +
  new URLSearchParams({
    from_post: order.from_post,
    to_post: order.to_post,
    recipient: order.recipient.email,
    description: order.description ?? "",
  });

/** The order page, filled in. @param {WantedOrder} wanted */
export const orderPage = (wanted) =>
  "/?" + new URLSearchParams(Object.entries(wanted).flatMap(([name, value]) => (typeof value === "string" ? [[name, value]] : [])));

const WANTED = ["from_post", "to_post", "recipient", "description", "not_before"];

/** Read the order that `repeatPage` wrote. @param {string} search @returns {Partial<WantedOrder>} */
export const wantedFrom = (search) =>
  Object.fromEntries([...new URLSearchParams(search)].filter(([name]) => WANTED.includes(name)));

/** @param {string} search the order that a follow page is about; null if the address names none */
export const orderFrom = (search) => new URLSearchParams(search).get("order");

/** Told to delegates, who may not follow the order: the mail that they got has a link of their own. */
const OF_DELEGATES = ["delegated", "delegation_over"];

/** The page that a notification leads to. @param {import("../../types/api_types.ts").NotificationView} notice */
export const pageOf = ({ order_id, kind }) => (order_id && !OF_DELEGATES.includes(kind) ? followPage(order_id) : null);
