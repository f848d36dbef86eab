// What a filled-in form asks of the service.
import { describe, expect, it } from "vitest";
import { type Choices, firstFilled, request, settled } from "../src/run/start/filled";

const CHOICES: Choices = {
  trees: [{ name: "kit", built_in: true }],
  worlds: [{ name: "tabletop", available: true, reason: null, options: {} }],
  sites: [],
  scenarios: [{ name: "dropped", tree: "kit", description: "", answers: ["yes"], built_in: true }],
  robots: [],
} as unknown as Choices;

describe("the request for a run", () => {
  const filled = { ...firstFilled("kit", CHOICES), scenario: "dropped", answers: "scenario", interventions: true } as const;

  it("says everything about a world of its own", () => {
    expect(request(filled)).toMatchObject({ world: "tabletop", scenario: "dropped", interventions: "random", answers: null });
  });

  it("leaves to a site what the site says", () => {
    const there = request(settled({ ...filled, site: "1a2b3c4d" }, CHOICES));
    expect(there).toEqual({ tree: "kit", site: "1a2b3c4d", max_attempts: 3, answers: "live", autonomy: "full" });
  });
});
