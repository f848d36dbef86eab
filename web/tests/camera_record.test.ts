import { describe, expect, it } from "vitest";
import { type KeptPicture, keptPictures, pictureNear } from "../src/run/camera_record";
import type { Event } from "../src/wire/types";

const kept: KeptPicture[] = [
  { camera: "forearm", time: 10, picture: "a" },
  { camera: "forearm", time: 10.4, picture: "b" },
  { camera: "head", time: 10.1, picture: "c" },
];

describe("pictureNear", () => {
  it("is the nearest of this camera", () => {
    expect(pictureNear(kept, "forearm", 10.3)?.picture).toBe("b");
    expect(pictureNear(kept, "head", 10.3)?.picture).toBe("c");
  });

  it("is nothing where nothing was kept about then", () => {
    expect(pictureNear(kept, "forearm", 12)).toBeNull();
    expect(pictureNear(kept, "wrist", 10)).toBeNull();
  });
});

describe("keptPictures", () => {
  it("has the fault's own picture and the clip before it", () => {
    const events = [
      { type: "issue_raised", time: 5, picture: "fault", detection: { camera: "head" } },
      { type: "clip_recorded", time: 5, pictures: [{ time: 4.8, picture: "before" }] },
      { type: "node_done", time: 6 },
    ] as unknown as Event[];
    expect(keptPictures(events)).toEqual([
      { camera: "head", time: 5, picture: "fault" },
      { camera: "forearm", time: 4.8, picture: "before" },
    ]);
  });
});
