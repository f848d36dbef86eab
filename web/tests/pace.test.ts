import { describe, expect, it } from "vitest";
import { createPace } from "../src/run/scene/pace";

function drawn(every: number, times: number) {
  const pace = createPace();
  return Array.from({ length: times }, (_, index) => pace(index * every)).filter((each) => each !== null);
}

describe("pace", () => {
  it("keeps every detail where drawing is quick enough", () => {
    expect(drawn(33, 200)).toEqual([]);
  });

  it("gives up detail step by step where it is slow, and ends with the least", () => {
    const steps = drawn(80, 200);
    expect(steps.map((each) => each.pixels)).toEqual([0.75, 0.75, 0.5]);
    expect(steps.at(-1)?.shadows).toBe(false);
  });

  it("does not take a pause for slowness", () => {
    expect(drawn(1000, 200)).toEqual([]);
  });
});
