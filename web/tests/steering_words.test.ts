// What is said of a run that waits to be let go, and what the tree shows of it.
import { describe, expect, it } from "vitest";
import { steeredOf } from "../src/run/steering/steered";
import { whyItWaits } from "../src/run/steering/steering_words";
import type { Steering } from "../src/run/steering/steering_fold";
import type { BreakpointSet, LeafHeld, LeafPreferred } from "../src/wire/types";

const held = { name: "blue_box", node: "/1/0", breakpoint: "/1", by: "ann", reason: "", level: "full" } as const;

describe("why a run waits", () => {
  it("names who has set the breakpoint, and their reason", () => {
    expect(whyItWaits(held)).toBe("waits before blue box: breakpoint set by ann.");
    expect(whyItWaits({ ...held, reason: "wet glue" })).toBe("waits before blue box: breakpoint set by ann (wet glue).");
  });

  it("names the level where that asks", () => {
    expect(whyItWaits({ ...held, breakpoint: null, by: null, level: "low" })).toBe(
      "waits before blue box: with autonomy low it asks first.",
    );
  });
});

describe("the marks in the tree", () => {
  it("are on the breakpoint and on the leaf that waits for it", () => {
    const steering: Steering = {
      autonomy: "full",
      breakpoints: new Map([["/1", {} as BreakpointSet]]),
      waiting: new Map(),
      preferred: { node: "/0" } as LeafPreferred,
    };
    expect([...steeredOf(steering, [held as unknown as LeafHeld])]).toEqual([
      ["/1", { breakpoint: true, waits: true, next: false }],
      ["/0", { breakpoint: false, waits: false, next: true }],
      ["/1/0", { breakpoint: false, waits: true, next: false }],
    ]);
  });
});
