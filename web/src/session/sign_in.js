/** Signing in: an address, then the code that was mailed to it. Tells `signed-in` with the person. */
import { html, nothing } from "lit";
import * as api from "../service/api.js";
import { atFields } from "../service/problems.js";
import { hasText, t } from "../texts/texts.js";
import { field, problemLine } from "../elements/field.js";
import { PageElement } from "../elements/page_element.js";
/** @import { About } from "../../types/api_types.ts" */

const FIELD_OF_CODE = { address_not_allowed: "email", wrong_code: "code", code_expired: "code" };

/** The problem code in the address after a refusal by the campus's own sign-in. @returns {Record<string, string>} */
function whatCameBack() {
  const here = new URL(location.href);
  const code = here.searchParams.get("sign_in_problem");
  if (!code) return {};
  here.searchParams.delete("sign_in_problem");
  history.replaceState(history.state, "", here);
  return { form: t(hasText(`error.${code}`) ? `error.${code}` : "error.oidc_refused") };
}

export class SignIn extends PageElement {
  static properties = {
    about: { attribute: false },
    email: {},
    again: { type: Boolean },
    codeSent: { state: true },
    sentAgain: { state: true },
    busy: { state: true },
    problems: { state: true },
  };

  constructor() {
    super();
    /** @type {About | null} */
    this.about = null;
    this.email = "";
    /** True in a dialog over a page that goes on afterwards and has its own heading. */
    this.again = false;
    this.codeSent = false;
    this.sentAgain = false;
    this.busy = false;
    /** @type {Record<string, string>} */
    this.problems = whatCameBack();
  }

  render() {
    const form = this.codeSent ? this.#codeForm() : [this.#emailForm(), this.#campus()];
    if (this.again) return form;
    return html`<section class="welcome">
      <img src="/icons/welcome.svg" alt="" class="picture" width="360" height="200" />
      <div class="card">
        <h1>${t("sign_in.title")}</h1>
        <p class="lead">${t("sign_in.lead")}</p>
        ${form}
      </div>
    </section>`;
  }

  #emailForm() {
    const domains = this.about?.allowed_domains.join(", ");
    return html`<form novalidate @submit=${this.#askForCode}>
      ${field(
        {
          name: "email",
          label: t("sign_in.email"),
          hint: domains ? t("sign_in.domains", { domains }) : undefined,
          problem: this.problems.email,
        },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="email" type="email" autocomplete="email"
          required .value=${this.email} aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${this.#formProblem()}
      <button class="main" ?disabled=${this.busy}>${t("sign_in.send")}</button>
    </form>`;
  }

  #campus() {
    if (!this.about?.campus_sign_in) return nothing;
    if (this.again) return html`<p class="hint">${t("sign_in.or_in_a_tab")}</p>${this.#campusLink("_blank")}`;
    return html`<p class="hint">${t("sign_in.or")}</p>${this.#campusLink()}`;
  }

  /** Another tab leaves this page as it is. @param {"_blank"} [target] */
  #campusLink(target) {
    return html`<a class="button" href=${api.CAMPUS_SIGN_IN} target=${target ?? nothing}>${t("sign_in.campus")}</a>`;
  }

  #codeForm() {
    return html`<form novalidate @submit=${this.#enter}>
      ${field(
        { name: "code", label: t("sign_in.code"), hint: t("sign_in.code_hint", { email: this.email }), problem: this.problems.code },
        ({ id, describedBy, invalid }) => html`<input id=${id} name="code" class="digits" inputmode="numeric" required
          autocomplete="one-time-code" maxlength="12" aria-describedby=${describedBy} aria-invalid=${invalid} />`,
      )}
      ${this.about?.demo ? html`<p class="hint">${t("sign_in.code_demo")}</p>` : nothing}
      ${this.#formProblem()}
      <button class="main" ?disabled=${this.busy}>${t("sign_in.enter")}</button>
      <button class="quiet" type="button" ?disabled=${this.busy} @click=${this.#sendAgain}>${t("sign_in.send_again")}</button>
      <button class="quiet" type="button" @click=${this.#startAgain}>${t("sign_in.other")}</button>
      <p role="status" class="hint">${this.sentAgain ? t("sign_in.sent_again", { email: this.email }) : nothing}</p>
    </form>`;
  }

  #formProblem() {
    return this.problems.form ? problemLine(this.problems.form) : nothing;
  }

  /** @param {SubmitEvent} event */
  async #askForCode(event) {
    event.preventDefault();
    const input = /** @type {HTMLInputElement} */ (this.querySelector("[name=email]"));
    this.email = input.value.trim();
    if (!this.email || input.validity.typeMismatch) return this.#refuse({ email: t("error.malformed.email") });
    await this.#attempt(async () => {
      await api.requestCode(this.email);
      this.codeSent = true;
      this.focusOn("[name=code]");
    });
  }

  /** @param {SubmitEvent} event */
  async #enter(event) {
    event.preventDefault();
    const input = /** @type {HTMLInputElement} */ (this.querySelector("[name=code]"));
    const code = input.value.replace(/\D/g, "");
    if (code.length !== 8) return this.#refuse({ code: t("error.malformed.code") });
    await this.#attempt(async () => {
      const detail = await api.signIn(this.email, code);
      this.dispatchEvent(new CustomEvent("signed-in", { detail }));
    });
  }

  #sendAgain() {
    this.sentAgain = false;
    return this.#attempt(async () => {
      await api.requestCode(this.email);
      this.sentAgain = true;
    });
  }

  #startAgain() {
    this.codeSent = this.sentAgain = false;
    this.problems = {};
    this.focusOn("[name=email]");
  }

  /** @param {() => Promise<void>} attempt */
  async #attempt(attempt) {
    if (this.busy) return;
    this.busy = true;
    this.problems = {};
    try {
      await attempt();
    } catch (failure) {
      this.#refuse(atFields(failure, FIELD_OF_CODE));
    } finally {
      this.busy = false;
    }
  }

  /** @param {Record<string, string>} problems */
  #refuse(problems) {
    this.problems = problems;
    this.focusOn("[aria-invalid]");
  }
}

customElements.define("sign-in", SignIn);
