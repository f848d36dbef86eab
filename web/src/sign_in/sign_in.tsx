// Coming in: the service's token where it wants one, and what to call this helper.
import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { helperName } from "../state/preferences";
import { call, session, sessionEnded, signIn } from "../state/service";
import { Refusal } from "../wire/rest";
import { whyNotDone } from "../words/said";
import { t } from "../words/words";
import "./sign_in.css";

export function SignIn() {
  return (
    <main class="sign-in" id="main">
      <div class="sign-in-brand">
        <img src="/icon.svg" alt="" width="56" height="56" />
        <h1>Mend</h1>
        <p class="quiet">{t("Robots ask here when they are stuck. You answer yes or no.")}</p>
      </div>
      {session.value === "needs_token" ? <TokenForm /> : <NameForm />}
    </main>
  );
}

function TokenForm() {
  const [mistake, setMistake] = useState("");
  const [shown, setShown] = useState(false);
  const [busy, setBusy] = useState(false);
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    const form = event.currentTarget as HTMLFormElement;
    setBusy(true);
    setMistake("");
    try {
      await signIn(String(new FormData(form).get("token")).trim());
    } catch (error) {
      setMistake(error instanceof Refusal && error.status === 401 ? t("This is not the token.") : whyNotDone(error));
      form.querySelector("input")?.select();
    } finally {
      setBusy(false);
    }
  };
  return (
    <Form onSubmit={(event) => void submit(event)} button={t("Sign in")} busy={busy}>
      {sessionEnded.value && (
        <p>
          {t("Your session has ended, {helper_name}. Nothing is lost: sign in and go on.", { helper_name: helperName.value })}
        </p>
      )}
      <div class="field">
        <label for="token">{t("Token")}</label>
        <div class="token-row">
          <input
            {...(shown ? { type: "text" } : { type: "password" })}
            id="token"
            name="token"
            required
            autocomplete="current-password"
            autocapitalize="off"
            spellcheck={false}
            aria-invalid={mistake !== ""}
            aria-describedby="token-hint token-mistake"
          />
          <button class="button" type="button" aria-pressed={shown} onClick={() => setShown(!shown)}>
            {t("Show")}
          </button>
        </div>
        <p id="token-hint" class="small quiet">
          {t("Your own, or the service's (its setting MEND_TOKEN): ask whoever runs it.")}
        </p>
      </div>
      <p id="token-mistake" class="mistake" role="alert">
        {mistake}
      </p>
    </Form>
  );
}

function NameForm() {
  const submit = (event: SubmitEvent) => {
    event.preventDefault();
    const name = String(new FormData(event.currentTarget as HTMLFormElement).get("name")).trim();
    if (name !== "") void call(name);
  };
  return (
    <Form onSubmit={submit} button={t("Begin")} busy={false}>
      <div class="field">
        <label for="name">{t("Your name")}</label>
        <input id="name" name="name" required maxlength={64} autocomplete="nickname" aria-describedby="name-hint" />
        <p id="name-hint" class="small quiet">
          {t("The robots and the other helpers see who answered.")}
        </p>
      </div>
    </Form>
  );
}

interface FormProps {
  onSubmit: (event: SubmitEvent) => void;
  button: string;
  busy: boolean;
  children: ComponentChildren;
}

function Form({ onSubmit, button, busy, children }: FormProps) {
  return (
    <form class="panel" onSubmit={onSubmit}>
      {children}
      <button class="button primary" type="submit" disabled={busy}>
        {button}
      </button>
    </form>
  );
}
