import { describe, expect, it } from "vitest";
import { createPace, type Detail, type Pace } from "../src/run/scene/pace";

function draw(pace: Pace, count: number, everyMs: number, from = 0): Detail[] {
  return Array.from({ length: count }, (_, index) => pace.drawn(from + everyMs * index)).filter((each) => each !== null);
}

describe("the pace of drawing", () => {
  it("keeps all detail while pictures come quickly enough", () => {
    const pace = createPace(false);
    expect(pace.first).toEqual({ pixels: 1, shadows: true });
    expect(draw(pace, 200, 30)).toEqual([]);
  });

  it("gives up detail step by step, and the shadows before the last of it", () => {
    const steps = draw(createPace(false), 200, 60);
    expect(steps.length).toBe(3);
    expect(steps.at(-1)).toEqual({ pixels: 0.5, shadows: false });
  });

  it("begins without shadows where no graphics processor helps", () => {
    const pace = createPace(true);
    expect(pace.first.shadows).toBe(false);
    expect(draw(pace, 200, 60).map((each) => each.pixels)).toEqual([0.75, 0.5]);
  });

  it("leaves out frames where no graphics processor helps, and holds that for no slowness", () => {
    const drawnAt = (pace: Pace, everyMs: number) =>
      Array.from({ length: 240 }, (_, index) => everyMs * index).filter((now) => {
        if (pace.early(now)) return false;
        expect(pace.drawn(now)).toBeNull();
        return true;
      });
    expect(drawnAt(createPace(true), 1000 / 60).length).toBe(120);
    expect(drawnAt(createPace(true), 1000 / 144).length).toBe(80);
    expect(drawnAt(createPace(false), 1000 / 60).length).toBe(240);
  });

  it("takes a pause for no slowness: nothing was to be drawn", () => {
    expect(draw(createPace(false), 200, 1000)).toEqual([]);
  });
});
