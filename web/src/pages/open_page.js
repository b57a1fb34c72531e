/** Opens a page: who is there, in which language, what time it is; then draws the page inside the shell. */
import { html, render } from "lit";
import * as api from "../service/api.js";
import { first, rememberLanguage } from "../service/early.js";
import "../elements/page_shell.js";
import { startLive } from "../live/live.js";
import { keepServerTime } from "../service/server_clock.js";
import { beginSession, hasKept } from "../session/session.js";
import { keepSession } from "../session/session_lost.js";
import { chooseLanguage, loadTexts, t } from "../texts/texts.js";
import { prepareTimes } from "../texts/times.js";
/** @import { About, Person } from "../../types/api_types.ts" */
/** @import { PageShell } from "../elements/page_shell.js" */
/** @import { PageName } from "../service/links.js" */

const LANGUAGES_WITHOUT_SERVICE = ["en", "fr"];

/**
 * @param {PageName} page
 * @param {(session: {about: About, person: Person}) => unknown} content what the page draws for a person who is signed in
 */
export async function openPage(page, content) {
  await orSayThatNobodyAnswers(async (root) => {
    const [about, person] = await first();
    const language = chooseLanguage(person ? [person.language] : navigator.languages, about.languages);
    rememberLanguage(language);
    await Promise.all([loadTexts(language), person ? undefined : import("../session/sign_in.js")]);
    document.title = `${t(person ? `title.${page}` : "title.sign_in")} · ${t("app.name")}`;
    keepServerTime(about);
    beginSession(person);
    keepSession(person);
    const kept = person && hasKept() ? await keptHere(person) : [];
    const draw = () => person && content({ about, person });
    render(
      html`<page-shell .page=${page} .about=${about} .person=${person} .content=${draw} .kept=${kept}></page-shell>`,
      root,
    );
    const shell = /** @type {PageShell} */ (root.querySelector("page-shell"));
    requestAnimationFrame(() => setTimeout(prepareTimes));
    await contentStands(shell);
    if (person) startLive(person.id);
    afterwards(() => import("./after_opening.js").then(({ afterOpening }) => afterOpening(shell, person)));
  });
}

/** Wait for the module of the page's content: nothing else is requested before it.
 *  @param {PageShell} shell */
async function contentStands(shell) {
  await shell.updateComplete;
  const coming = Array.from(shell.querySelectorAll("#content > :not(:defined)"), ({ localName }) => localName);
  await Promise.all(coming.map((name) => customElements.whenDefined(name)));
}

/** Orders that wait on this device have their room from the start. @param {Person} person */
async function keptHere(person) {
  const [{ keptOrders }] = await Promise.all([import("../offline/outbox.js"), import("../offline/kept_orders.js")]);
  return keptOrders(person.id).catch(() => []);
}

/** Run low-priority work once the page stands. @param {() => unknown} work */
function afterwards(work) {
  const whenIdle = () => ("requestIdleCallback" in window ? requestIdleCallback(work, { timeout: 3_000 }) : setTimeout(work, 500));
  if (document.readyState === "complete") whenIdle();
  else addEventListener("load", whenIdle, { once: true });
}

/**
 * Opens a page for a guest, who needs no account.
 * @param {string} title @param {() => unknown} content
 */
export async function openPageForGuest(title, content) {
  await orSayThatNobodyAnswers(async (root) => {
    const [about] = await first();
    await loadTexts(chooseLanguage(navigator.languages, about.languages));
    document.title = `${t(title)} · ${t("app.name")}`;
    keepServerTime(about);
    render(html`${guestHeader()}<main id="content" tabindex="-1">${content()}</main>`, root);
    afterwards(() => import("../offline/with_worker.js").then(({ workOffline }) => workOffline(null)));
  });
}

const guestHeader = () => html`<header class="top">
  <span class="brand"><img src="/icons/icon.svg" alt="" width="32" height="32" />${t("app.name")}</span>
</header>`;

/** @param {(root: HTMLElement) => Promise<void>} open */
async function orSayThatNobodyAnswers(open) {
  const root = /** @type {HTMLElement} */ (document.querySelector("#page"));
  try {
    await open(root);
  } catch (failure) {
    if (!(failure instanceof api.NoAnswer || failure instanceof api.ApiProblem)) throw failure;
    await sayThatNobodyAnswers(root);
  }
}

/** @param {HTMLElement} root */
async function sayThatNobodyAnswers(root) {
  await loadTexts(chooseLanguage(navigator.languages, LANGUAGES_WITHOUT_SERVICE));
  render(
    html`<main class="blank">
      <h1>${t("app.failed.title")}</h1>
      <p>${t("app.failed.body")}</p>
      <button class="main" @click=${() => location.reload()}>${t("app.failed.again")}</button>
    </main>`,
    root,
  );
}
