// Where in a building the robot asks: a small map, loaded after the question is there.
import { later } from "../app/later";
import type { Question } from "../state/questions";
import { runs } from "../state/service";

const PlaceMap = later(() => import("../building/place_map").then((module) => module.PlaceMap));

const IN_BUILDINGS = "building";
/** What a base sees with, as its detections name it. */
const LASER = "laser";

export function AskingPlace({ question: { run, robot, detection } }: { question: Question }) {
  const inBuilding = runs.value.get(run)?.world === IN_BUILDINGS || detection?.camera === LASER;
  return inBuilding ? <PlaceMap run={run} robot={robot} /> : null;
}
