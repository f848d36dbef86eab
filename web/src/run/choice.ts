// Why a robot took the leaf that it took.
import { plain } from "../tree/words";
import type { Candidate, NodeStarted } from "../wire/types";
import { decimal, t } from "../words/words";

/** One sentence: what made the chosen leaf the best of the candidates. */
export function whyChosen(event: NodeStarted): string {
  const chosen = event.candidates.find((candidate) => candidate.node === event.node);
  const others = event.candidates.filter((candidate) => candidate.node !== event.node);
  const name = plain(event.name);
  if (chosen?.asked_for_by != null)
    return t("{asked_for_by} has asked for {name} next.", { asked_for_by: chosen.asked_for_by, name });
  if (chosen === undefined) return t("{name} was started again where it was.", { name });
  if (others.length === 0) return t("{name} was the only one that could be started.", { name });
  if (chosen.in_place) return t("What {name} handles stands at its place already.", { name });
  const fewer = others.filter((other) => other.attempts > chosen.attempts);
  const alike = others.filter((other) => other.attempts === chosen.attempts);
  if (alike.length === 0)
    return t("{name} had the fewest failed attempts ({attempts}).", { name, attempts: chosen.attempts });
  const passed =
    fewer.length > 0 ? t(", after leaving out {fewer} with more failed attempts", { fewer: names(fewer) }) : "";
  const best = Math.max(...alike.map((other) => other.potential));
  if (chosen.potential > best) {
    const nearest = decimal(chosen.potential, 2);
    return t("{name} had the highest potential ({nearest}, the next {best}){passed}.", {
      name,
      nearest,
      best: decimal(best, 2),
      passed,
    });
  }
  return t("{name} had the same potential as others ({best}) and comes first in the tree{passed}.", {
    name,
    best: decimal(best, 2),
    passed,
  });
}

function names(candidates: readonly Candidate[]): string {
  const shown = candidates.slice(0, 3).map((candidate) => plain(candidate.name));
  const more = candidates.length - shown.length;
  return more > 0 ? t("{shown} and {more} more", { shown: shown.join(", "), more }) : shown.join(t(" and "));
}
