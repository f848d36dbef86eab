// What runs and issues are searched for: words, and the days between which they were.

export interface Search {
  readonly text: string;
  /** Days as their fields have them, "2026-11-27"; empty for any. */
  readonly from: string;
  readonly to: string;
}

export const ANYTHING: Search = { text: "", from: "", to: "" };

export function isAnything({ text, from, to }: Search): boolean {
  return text.trim() === "" && from === "" && to === "";
}

/** The query of an address that finds it; days begin and end as those of whoever searches. */
export function queryOf(search: Search): URLSearchParams {
  const query = new URLSearchParams();
  if (search.text.trim() !== "") query.set("text", search.text.trim());
  const [from, to] = [dayBegins(search.from, 0), dayBegins(search.to, 1)];
  if (from !== null) query.set("since", from);
  if (to !== null) query.set("until", to);
  return query;
}

/** When a day begins, or one some days later; null without one. */
function dayBegins(day: string, later: number): string | null {
  const [year, month, date] = day.split("-").map(Number);
  if (year === undefined || month === undefined || date === undefined) return null;
  const begins = new Date(year, month - 1, date + later);
  return Number.isNaN(begins.getTime()) ? null : begins.toISOString();
}
