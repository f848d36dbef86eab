// The pictures that a run's journal keeps: those of faults, and the seconds before them.
import type { Event } from "../wire/types";

export interface KeptPicture {
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
    if (event.type === "issue_raised" && event.picture !== null) {
      return [{ camera: event.detection?.camera ?? CLIP_CAMERA, time: event.time, picture: event.picture }];
    }
    if (event.type !== "clip_recorded") return [];
    return event.pictures.map((each) => ({ camera: CLIP_CAMERA, ...each }));
  });
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
