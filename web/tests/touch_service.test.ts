// What a robot's touch screen says of whether that robot is in service, and who else is.
import { describe, expect, it } from "vitest";
import { serviceOf } from "../src/touch/service";
import type { FleetView } from "../src/wire/types";

const robot = (name: string, out: string | null, works = out === null) =>
  ({ robot: name, works, out_of_service: out }) as FleetView["robots"][number];

describe("the robot at whose touch screen somebody stands", () => {
  it("is in service where nobody has taken it out", () => {
    expect(serviceOf("r0", { robots: [robot("r0", null), robot("r1", "stuck")] })).toBe("in");
  });

  it("says that another one comes only where one works", () => {
    expect(serviceOf("r0", { robots: [robot("r0", "stuck"), robot("r1", null)] })).toBe("out");
    expect(serviceOf("r0", { robots: [robot("r0", "stuck")] })).toBe("alone");
    expect(serviceOf("r0", { robots: [robot("r0", "stuck"), robot("r1", "dusty", true)] })).toBe("alone");
    expect(serviceOf("r0", { robots: [robot("r0", "stuck"), robot("r1", null, false)] })).toBe("alone");
  });
});
