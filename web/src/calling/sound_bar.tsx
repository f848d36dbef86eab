// Says that this page calls nobody by sound until it was touched once, where that matters.
import { besideRobot, soundOn } from "../state/preferences";
import { rings } from "./calls";
import { soundBlocked, unlock } from "./sounds";
import { t } from "../words/words";
import "./sound_bar.css";

export function SoundBar() {
  const matters = soundOn.value && soundBlocked.value && (besideRobot.value || rings.value.length > 0);
  return (
    <div class="sound-bar" role="status">
      {matters && (
        <>
          <p>
            <strong>{t("You do not hear this page yet.")}</strong> {t("Browsers wait until it is touched once.")}
          </p>
          <button type="button" class="button" onClick={() => void unlock()}>
            {t("Turn the sound on")}
          </button>
        </>
      )}
    </div>
  );
}
