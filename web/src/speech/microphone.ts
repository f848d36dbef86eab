// The microphone as 16 kHz PCM.
import workletAddress from "./microphone_worklet?worker&url";
import { t } from "../words/words";

const SAMPLE_RATE_HZ = 16_000;

export interface Microphone {
  close(): void;
}

/** Open it; rejects when there is none or the helper does not let this page listen. */
export async function openMicrophone(onFrame: (pcm: ArrayBuffer) => void): Promise<Microphone> {
  if (navigator.mediaDevices === undefined) throw new Error(t("the browser lets only secure pages (https) listen"));
  const stream = await navigator.mediaDevices.getUserMedia({
    audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true },
  });
  const context = new AudioContext({ sampleRate: SAMPLE_RATE_HZ });
  const close = () => {
    for (const track of stream.getTracks()) track.stop();
    void context.close();
  };
  try {
    await context.audioWorklet.addModule(workletAddress);
    const frames = new AudioWorkletNode(context, "microphone-frames", { numberOfOutputs: 0 });
    frames.port.onmessage = (message) => onFrame(message.data as ArrayBuffer);
    context.createMediaStreamSource(stream).connect(frames);
    await context.resume();
  } catch (error) {
    close();
    throw error;
  }
  return { close };
}
