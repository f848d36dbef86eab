// What a helper can set on this device.
import { helperName, type Theme, theme } from "../state/preferences";
import { call, signOut, tokenRequired } from "../state/service";

const THEMES: readonly (readonly [Theme, string])[] = [
  ["system", "As the device"],
  ["light", "Light"],
  ["dark", "Dark"],
];

export function SettingsView() {
  const rename = (event: Event) => {
    const name = (event.currentTarget as HTMLInputElement).value.trim();
    if (name !== "") void call(name);
  };
  return (
    <section class="page">
      <h1>Settings</h1>
      <div class="panel field">
        <label for="helper-name">Your name</label>
        <input id="helper-name" value={helperName.value} maxlength={64} onChange={rename} />
      </div>
      <fieldset class="panel">
        <legend>Colours</legend>
        {THEMES.map(([value, text]) => (
          <label key={value}>
            <input
              type="radio"
              name="theme"
              checked={theme.value === value}
              onChange={() => {
                theme.value = value;
              }}
            />
            {text}
          </label>
        ))}
      </fieldset>
      {tokenRequired.value && (
        <button class="button" type="button" onClick={() => void signOut()}>
          Sign out
        </button>
      )}
    </section>
  );
}
