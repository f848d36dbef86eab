// The pictures that a run's journal keeps: of faults and the seconds around them, and what people had recorded.
import type { Event } from "../wire/types";

export interface KeptPicture {
  readonly robot: string;
  readonly camera: string;
  /** Seconds of the run's clock. */
  readonly time: number;
  readonly picture: string;
}

// Clips come from the camera on the forearm, some pictures a second.
const CLIP_CAMERA = "forearm";
const NEAR_S = 1;

export function keptPictures(events: readonly Event[]): KeptPicture[] {
  return events.flatMap((event): KeptPicture[] => {
    switch (event.type) {
      case "issue_raised": {
        const { robot, time, picture, detection } = event;
        return picture === null ? [] : [{ robot, camera: detection?.camera ?? CLIP_CAMERA, time, picture }];
      }
      case "clip_recorded":
        return event.pictures.map((each) => ({ robot: event.robot, camera: CLIP_CAMERA, ...each }));
      case "cameras_recorded":
        return event.pictures.map((each) => ({ robot: event.robot, ...each }));
      default:
        return [];
    }
  });
}

const USUAL = ["head", "forearm"];

/** The cameras to be shown: those that a robot has, or that pictures are kept of, and else what arms have; the usual ones first. */
export function camerasOf(has: readonly string[], kept: readonly KeptPicture[]): string[] {
  const known = new Set([...has, ...kept.map(({ camera }) => camera)]);
  const usual = USUAL.filter((each) => known.size === 0 || known.has(each));
  return [...usual, ...[...known].filter((each) => !USUAL.includes(each)).sort()];
}

/** What a camera saw nearest to a time; null if nothing is kept from about then. */
export function pictureNear(kept: readonly KeptPicture[], camera: string, time: number): KeptPicture | null {
  let nearest: KeptPicture | null = null;
  for (const each of kept) {
    if (each.camera !== camera || Math.abs(each.time - time) > NEAR_S) continue;
    if (nearest === null || Math.abs(each.time - time) < Math.abs(nearest.time - time)) nearest = each;
  }
  return nearest;
}

/** Whose picture it is, where robots' pictures could be taken for one another's. */
export function ownerOf(kept: readonly KeptPicture[], picture: KeptPicture): string | null {
  return kept.some((each) => each.robot !== picture.robot) ? picture.robot : null;
}
