import { describe, expect, it } from "vitest";
import { offersFor, sentenceOn } from "../src/run/scene/interventions";

const leg = { kind: "object", name: "green_leg", held: false, gone: false } as const;
const labels = (...given: Parameters<typeof offersFor>) => offersFor(...given).map((each) => each.label);

describe("offersFor", () => {
  it("offers all that can be done with an object on the table", () => {
    expect(labels(leg, ["green_leg"])).toEqual(["Steal", "Put back", "Place", "Hand over", "Move …"]);
  });

  it("does not steal what is gone", () => {
    expect(labels({ ...leg, gone: true }, [])).toEqual(["Put back", "Hand over", "Move …"]);
  });

  it("pulls only what is held, and hands over only what is not", () => {
    const held = labels({ ...leg, held: true }, []);
    expect(held).toContain("Pull out");
    expect(held).not.toContain("Hand over");
  });

  it("places an object at the place of its name alone", () => {
    expect(labels(leg, ["blue_leg"])).not.toContain("Place");
  });

  it("blocks a free way and releases a blocked one", () => {
    expect(labels({ kind: "arm", blocked: false }, [])).toEqual(["Block"]);
    expect(labels({ kind: "arm", blocked: true }, [])).toEqual(["Release"]);
  });
});

describe("offersFor the head", () => {
  it("covers its camera and clears the view again", () => {
    expect(labels({ kind: "head" }, [])).toEqual(["Cover", "Uncover"]);
  });
});

describe("sentenceOn", () => {
  it("speaks of the object in plain words", () => {
    expect(sentenceOn({ act: "steal", object: "green_leg" })).toBe("The green leg is taken away.");
  });
});
