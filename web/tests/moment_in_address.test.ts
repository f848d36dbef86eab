// A moment of a run in its address.
import { describe, expect, it } from "vitest";
import { momentIn, withMoment } from "../src/run/moment_in_address";

describe("a moment in an address", () => {
  it("comes back as it was, to a tenth of a second", () => {
    for (const [time, told] of [[0, 0], [0.1, 0.1], [0.7, 0.7], [62.4, 62.4], [62.40000001, 62.5], [7.44, 7.5], [3600.95, 3601]] as const) {
      const [, search] = withMoment("/runs/a", time).split("?");
      expect(momentIn(`?${search}`)).toBeCloseTo(told, 6);
    }
    expect(withMoment("/runs/a", null)).toBe("/runs/a");
  });

  it("is none where it is not a time", () => {
    for (const search of ["", "?t=", "?t=%20", "?t=soon", "?t=-3", "?t=Infinity", "?u=3"]) expect(momentIn(search)).toBeNull();
  });
});
