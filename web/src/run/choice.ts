// Why a robot took the leaf that it took.
import { plain } from "../tree/words";
import type { Candidate, NodeStarted } from "../wire/types";

/** One sentence: what made the chosen leaf the best of the candidates. */
export function whyChosen(event: NodeStarted): string {
  const chosen = event.candidates.find((candidate) => candidate.node === event.node);
  const others = event.candidates.filter((candidate) => candidate.node !== event.node);
  const name = plain(event.name);
  if (chosen?.asked_for_by != null) return `${chosen.asked_for_by} has asked for ${name} next.`;
  if (chosen === undefined) return `${name} was started again where it was.`;
  if (others.length === 0) return `${name} was the only one that could be started.`;
  if (chosen.in_place) return `What ${name} handles stands at its place already.`;
  const fewer = others.filter((other) => other.attempts > chosen.attempts);
  const alike = others.filter((other) => other.attempts === chosen.attempts);
  if (alike.length === 0) return `${name} had the fewest failed attempts (${chosen.attempts}).`;
  const passed = fewer.length > 0 ? `, after leaving out ${names(fewer)} with more failed attempts` : "";
  const best = Math.max(...alike.map((other) => other.potential));
  if (chosen.potential > best) {
    const nearest = chosen.potential.toFixed(2);
    return `${name} had the highest potential (${nearest}, the next ${best.toFixed(2)})${passed}.`;
  }
  return `${name} had the same potential as others (${best.toFixed(2)}) and comes first in the tree${passed}.`;
}

function names(candidates: readonly Candidate[]): string {
  const shown = candidates.slice(0, 3).map((candidate) => plain(candidate.name));
  const more = candidates.length - shown.length;
  return more > 0 ? `${shown.join(", ")} and ${more} more` : shown.join(" and ");
}
