import { describe, expect, it } from "vitest";
import { type KeptPicture, keptPictures, ownerOf, pictureNear } from "../src/run/camera_record";
import type { Event } from "../src/wire/types";

const kept: KeptPicture[] = [
  { robot: "arm", camera: "forearm", time: 10, picture: "a" },
  { robot: "arm", camera: "forearm", time: 10.4, picture: "b" },
  { robot: "arm", camera: "head", time: 10.1, picture: "c" },
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
  it("has the fault's own picture, the clip before it, and what was recorded after it", () => {
    const events = [
      { type: "issue_raised", robot: "arm", time: 5, picture: "fault", detection: { camera: "head" } },
      { type: "clip_recorded", robot: "arm", time: 5, pictures: [{ time: 4.8, picture: "before" }] },
      {
        type: "cameras_recorded",
        robot: "arm",
        time: 7,
        pictures: [
          { camera: "head", time: 6, picture: "after" },
          { camera: "forearm", time: 6, picture: "also after" },
        ],
      },
      { type: "node_done", time: 6 },
    ] as unknown as Event[];
    expect(keptPictures(events)).toEqual([
      { robot: "arm", camera: "head", time: 5, picture: "fault" },
      { robot: "arm", camera: "forearm", time: 4.8, picture: "before" },
      { robot: "arm", camera: "head", time: 6, picture: "after" },
      { robot: "arm", camera: "forearm", time: 6, picture: "also after" },
    ]);
  });
});

describe("ownerOf", () => {
  it("is told where robots' pictures could be taken for one another's", () => {
    const [first] = kept as [KeptPicture];
    expect(ownerOf(kept, first)).toBeNull();
    const other = { robot: "other", camera: "head", time: 10, picture: "d" };
    expect(ownerOf([...kept, other], first)).toBe("arm");
  });
});
