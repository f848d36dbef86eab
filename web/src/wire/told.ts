// An event as the console asks for it: with what the transcript tells of it.
import type { Event, TranscriptLine } from "./types";

export type Told = Event & { readonly lines: readonly TranscriptLine[] };
