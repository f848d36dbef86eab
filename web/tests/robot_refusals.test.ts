// Why a robot was not sent is told while it is so, and no longer.
import { expect, it } from "vitest";
import { NOT_REFUSED, refusedStill } from "../src/fleet/use_refusal";

it("a refusal goes once its robot is no more as it was when that was read after it", () => {
  const refused = { text: "Robot r0 is at work for 't3'.", state: null };
  const read = refusedStill(refused, "at t3");
  expect(read).toEqual({ ...refused, state: "at t3" });
  expect(refusedStill(read, "at t3")).toBe(read);
  expect(refusedStill(read, "idle")).toBe(NOT_REFUSED);
  expect(refusedStill(NOT_REFUSED, "idle")).toBe(NOT_REFUSED);
});
