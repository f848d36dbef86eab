// Where no robot asks anything: whether the runs go on, what has failed, and which robots are gone.
import type { Sign } from "./glance";
import { AtFault } from "./at_fault";
import { tellsOf, useGlance } from "./use_glance";
import { t } from "../words/words";
import "./at_a_glance.css";

const SIGNS: Readonly<Record<Sign, string>> = {
  well: "m14 25 7 7 13-15",
  idle: "M14 24h20",
  bad: "M24 12v15M24 33v2",
  unknown: "M18 19a6 6 0 1 1 8.500 5.500c-2 1-2.500 2-2.500 4M24 34v1",
};

export function AtAGlance() {
  const glance = useGlance();
  const { sign, words, more } = glance;
  return (
    <div class="glance">
      <svg class={sign} viewBox="0 0 48 48" width="64" height="64" aria-hidden="true">
        <circle cx="24" cy="24" r="21" />
        <path d={SIGNS[sign]} />
      </svg>
      <p class="glance-words">{words}</p>
      {tellsOf(glance) && <AtFault glance={glance} />}
      <p class="quiet">{more} {t("This page tells you when a robot asks. You can leave it open and do something else.")}</p>
    </div>
  );
}
