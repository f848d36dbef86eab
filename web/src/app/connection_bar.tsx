// Says calmly that the connection is lost, since when, and that nothing is lost with it; or that the
// service cannot keep what happens, so that the robots hold.
import { hurry, lostSince, trouble } from "../state/service";
import { t } from "../words/words";
import { said } from "../words/said";
import { locale } from "../words/language";

const CLOCK = new Intl.DateTimeFormat(locale, { timeStyle: "medium" });

export function ConnectionBar() {
  const since = lostSince.value;
  return (
    <div class="connection-bar" role="status">
      {since !== null && (
        <p>
          <strong>{t("No connection since {since}.", { since: CLOCK.format(since) })}</strong>{" "}{t("Nothing is lost: the service keeps every question, and this page catches up by itself.")}</p>
      )}
      {since === null && trouble.value !== null && (
        <p>
          <strong>{t("The robots are told to hold: {trouble}.", { trouble: said(trouble.value) })}</strong>{" "}{t("Everything goes on by itself once it can be.")}</p>
      )}
      {since !== null && (
        <button class="button" type="button" onClick={hurry}>{t("Try now")}</button>
      )}
    </div>
  );
}
