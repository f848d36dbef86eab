import { expect, test } from "vitest";
import { momentOf, outcomeOf } from "../src/issues/issue_words";
import { ANYTHING, isAnything, queryOf } from "../src/run/search";
import type { IssueSummary } from "../src/wire/types";

const ISSUE = { run: "r", time: 12.31, outcome: null, dialogue: null } as IssueSummary;

test("nothing is asked for where nothing is filled in", () => {
  expect(queryOf(ANYTHING).toString()).toBe("");
  expect(isAnything(ANYTHING)).toBe(true);
  expect(isAnything({ ...ANYTHING, text: "  " })).toBe(true);
  expect(isAnything({ ...ANYTHING, to: "2026-11-27" })).toBe(false);
});

test("words are searched for without the blanks around them", () => {
  expect(queryOf({ ...ANYTHING, text: " pink bar & more " }).get("text")).toBe("pink bar & more");
});

test("a day is meant from its first moment to its last, as those who search have it", () => {
  const query = queryOf({ text: "", from: "2026-02-28", to: "2026-02-28" });
  expect(query.get("since")).toBe(new Date(2026, 1, 28).toISOString());
  expect(query.get("until")).toBe(new Date(2026, 2, 1).toISOString());
});

test("a day that is half typed is none", () => {
  expect(queryOf({ ...ANYTHING, from: "2026-0" }).toString()).toBe("");
});

test("an issue is shown at a moment at which it was raised already", () => {
  expect(momentOf(ISSUE)).toBe("/runs/r?t=12.4");
  expect(momentOf({ ...ISSUE, time: 12 })).toBe("/runs/r?t=12.0");
});

test("how an issue ended is said, or that nobody was asked", () => {
  expect(outcomeOf(ISSUE)).toBe("Nobody was asked");
  expect(outcomeOf({ ...ISSUE, dialogue: "d" })).toBe("Being asked about");
  expect(outcomeOf({ ...ISSUE, dialogue: "d", outcome: "left_out" })).toBe("Left out");
});
