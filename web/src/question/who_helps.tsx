// Who helps besides this helper, and whether this helper counts as here themselves.
import { useEffect, useState } from "preact/hooks";
import { presence } from "../calling/presence";
import { may } from "../state/access";
import { helperName } from "../state/preferences";
import { connection, onEvent, onSnapshot } from "../state/service";
import { t } from "../words/words";
import * as rest from "../wire/rest";
import type { Event, HelpersView, HelperView } from "../wire/types";
import "./who_helps.css";

/** Whoever leaves a page is no event: it is looked for now and then. */
const AGAIN_MS = 15_000;

const CHANGES_WORK: ReadonlySet<Event["type"]> = new Set([
  "prompt",
  "answered",
  "claimed",
  "released",
  "help_awaited",
  "help_verified",
  "promise_taken_back",
  "dialogue_closed",
]);

export function WhoHelps() {
  const { in_turn, helpers } = useHelpers();
  if (connection.value !== "connected") return null;
  const others = helpers.filter((each) => each.helper !== helperName.value);
  const me = helpers.find((each) => each.helper === helperName.value);
  if (others.length === 0 && presence.value !== "away") return null;
  return (
    <section class="who-helps" aria-labelledby="who-helps">
      <h2 id="who-helps">{t("Who helps")}</h2>
      {may("helper") && <p class="small">{aboutMe(in_turn && others.length > 0)}</p>}
      {others.length > 0 && (
        <ul>
          {[...(me === undefined ? [] : [me]), ...others].map((each) => (
            <Helper key={each.helper} helper={each} />
          ))}
        </ul>
      )}
    </section>
  );
}

/** This page knows sooner than the service. */
function aboutMe(inTurn: boolean): string {
  if (presence.value === "away") {
    return inTurn
      ? t("You count as away, as nobody has touched this page for a while: whoever is here is asked before you. Touch it or press a key to be here.")
      : t("You count as away, as nobody has touched this page for a while. You are called all the same.");
  }
  if (presence.value === "beside") return t("This page stands beside a robot: it always counts as here.");
  return inTurn ? t("You count as here: who is here and has nothing to do is asked first.") : t("You count as here. Everybody is asked at once.");
}

function Helper({ helper: each }: { helper: HelperView }) {
  const mine = each.helper === helperName.value;
  const reach = mine ? (presence.value === "away" ? "away" : "here") : each.reach;
  const busy = each.on > 0 || each.asked > 0;
  return (
    <li class={`${reach} ${busy ? "busy" : ""}`}>
      <strong>{mine ? t("{helper} (you)", { helper: each.helper }) : each.helper}</strong>: {standing(reach, each)}
    </li>
  );
}

function standing(reach: HelperView["reach"], { on, asked }: HelperView): string {
  if (on > 0) return t("busy: on a question or at help");
  if (asked > 0) return reach === "here" ? t("here, is being asked") : t("is being called");
  switch (reach) {
    case "here":
      return t("here");
    case "away":
      return t("away, with a page open");
    case "called":
      return t("not signed in, called by push");
    case "gone":
      return t("not signed in, hears no call");
  }
}

function useHelpers(): HelpersView {
  const [helpers, setHelpers] = useState<HelpersView>({ in_turn: false, helpers: [] });
  useEffect(() => {
    let current = true;
    const read = () => void rest.helpers().then((found) => current && setHelpers(found), () => undefined);
    const stop = [onSnapshot(read), onEvent((event) => CHANGES_WORK.has(event.type) && read())];
    const timer = window.setInterval(() => document.visibilityState !== "hidden" && read(), AGAIN_MS);
    read();
    return () => {
      current = false;
      window.clearInterval(timer);
      stop.forEach((each) => each());
    };
  }, []);
  return helpers;
}
