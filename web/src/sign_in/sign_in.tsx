// Coming in: the service's token where it wants one, and what to call this helper.
import { useState } from "preact/hooks";
import { call, session, signIn } from "../state/service";
import { Refusal } from "../wire/rest";
import "./sign_in.css";

export function SignIn() {
  return (
    <main class="sign-in" id="main">
      <img src="/icon.svg" alt="" width="56" height="56" />
      <h1>Mend</h1>
      {session.value === "needs_token" ? <TokenForm /> : <NameForm />}
    </main>
  );
}

function TokenForm() {
  const [mistake, setMistake] = useState("");
  const submit = async (event: SubmitEvent) => {
    event.preventDefault();
    const form = event.currentTarget as HTMLFormElement;
    try {
      await signIn(String(new FormData(form).get("token")));
    } catch (error) {
      setMistake(error instanceof Refusal && error.status === 401 ? "This is not the token." : String(error));
      form.querySelector("input")?.select();
    }
  };
  return (
    <form class="panel" onSubmit={submit}>
      <div class="field">
        <label for="token">Token</label>
        <input
          id="token"
          name="token"
          type="password"
          required
          autocomplete="current-password"
          aria-describedby="token-hint token-mistake"
        />
        <p id="token-hint" class="small quiet">
          Whoever runs the service has it (its setting MEND_TOKEN).
        </p>
      </div>
      <p id="token-mistake" class="mistake" role="alert">
        {mistake}
      </p>
      <button class="button primary" type="submit">
        Sign in
      </button>
    </form>
  );
}

function NameForm() {
  const submit = (event: SubmitEvent) => {
    event.preventDefault();
    const name = String(new FormData(event.currentTarget as HTMLFormElement).get("name")).trim();
    if (name !== "") void call(name);
  };
  return (
    <form class="panel" onSubmit={submit}>
      <div class="field">
        <label for="name">Your name</label>
        <input id="name" name="name" required maxlength={64} autocomplete="nickname" aria-describedby="name-hint" />
        <p id="name-hint" class="small quiet">
          The robots and the other helpers see who answered.
        </p>
      </div>
      <button class="button primary" type="submit">
        Begin
      </button>
    </form>
  );
}
