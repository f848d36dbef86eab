// Switches the spoken side on and off; its code is loaded when it is first used.
import { speechPhase } from "./speech_state";

let stop: (() => void) | null = null;

/** Rejects where its code cannot be loaded. */
export async function switchOn(): Promise<void> {
  speechPhase.value = "starting";
  try {
    const { beginToSpeak } = await import("./spoken_dialogue");
    stop = await beginToSpeak();
  } catch (error) {
    speechPhase.value = "off";
    throw error;
  }
}

export function switchOff(): void {
  stop?.();
  stop = null;
}
