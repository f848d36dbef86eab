// How wide somebody has drawn the parts of runs' pages on this device.
import { kept } from "../state/preferences";
import { AS_MADE, type RunLayout } from "./run_layout";

export const runLayout = kept<RunLayout>("run_layout", AS_MADE);
