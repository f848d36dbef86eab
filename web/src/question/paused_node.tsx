// Where in its task tree the robot stopped: a small drawing, loaded after the question is there.
import { later } from "../app/later";

export const PausedNode = later(() => import("./paused_tree").then((module) => module.PausedTree));
