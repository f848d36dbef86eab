// Home: what there is besides questions. Beneath a question it is folded, and read only when somebody opens it.
import { useState } from "preact/hooks";
import { AtFault } from "../question/at_fault";
import { tellsOf, useGlance } from "../question/use_glance";
import { fleets } from "../requests/fleets";
import { connection } from "../state/service";
import { t, tn } from "../words/words";
import { OpenRequests } from "./open_requests";
import { RecentAnswers } from "./recent_answers";
import { RobotsHere } from "./robots_here";
import { RunsGoingOn } from "./runs_going_on";
import { TryDemo } from "./try_demo";
import "./home.css";

export function Overview({ asked }: { asked: boolean }) {
  const [open, setOpen] = useState(false);
  const glance = useGlance();
  if (connection.value !== "connected") return null;
  if (!asked) return <Everything />;
  const wrong = glance.failures.length + glance.lost.length;
  return (
    <details class="home-folded" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>
        {t("What else goes on")}
        {wrong > 0 && <strong> · {tn("one thing is wrong", "{count} things are wrong", { count: wrong })}</strong>}
      </summary>
      {open && (
        <>
          {tellsOf(glance) && <AtFault glance={glance} />}
          <Everything />
        </>
      )}
    </details>
  );
}

function Everything() {
  return (
    <div class="home">
      <TryDemo />
      <RunsGoingOn />
      <RobotsHere />
      {fleets.value?.map((site) => <OpenRequests key={site.id} site={site} />)}
      <RecentAnswers />
    </div>
  );
}
