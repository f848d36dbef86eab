// Desktop notifications: the browser is asked for leave only when the helper asks for them.
import { useState } from "preact/hooks";
import { notificationsOn, pushOn } from "../state/preferences";
import { t } from "../words/words";

export function Notifications() {
  const available = "Notification" in window;
  const [allowed, setAllowed] = useState(available ? Notification.permission : "denied");
  // Calls to this device show the same.
  if (pushOn.value) return null;
  if (!available) return <p class="small quiet">{t("This browser has no desktop notifications.")}</p>;
  const ask = async () => {
    const answer = await Notification.requestPermission();
    setAllowed(answer);
    notificationsOn.value = answer === "granted";
  };
  if (allowed === "granted") {
    return (
      <label class="choice">
        <input
          type="checkbox"
          checked={notificationsOn.value}
          onChange={(event) => {
            notificationsOn.value = event.currentTarget.checked;
          }}
        />
        {t("Show a desktop notification while this page is in the background")}
      </label>
    );
  }
  return (
    <div class="setting-row">
      <button type="button" class="button" disabled={allowed === "denied"} onClick={() => void ask()}>
        {t("Allow desktop notifications")}
      </button>
      <p class="small quiet" role="status">
        {allowed === "denied" &&
          t("This browser does not let this page notify you. Its site settings can change that.")}
      </p>
    </div>
  );
}
