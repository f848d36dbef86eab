// Two short tones that say that a robot asks.

const TONES = [
  { hertz: 660, from_s: 0 },
  { hertz: 880, from_s: 0.16 },
];
const LENGTH_S = 0.22;

let context: AudioContext | null = null;

/** Play it, as far as the browser lets a page that nobody has touched yet make a sound. */
export function playChime(): void {
  context ??= new AudioContext();
  void context.resume();
  for (const { hertz, from_s } of TONES) {
    const tone = new OscillatorNode(context, { frequency: hertz });
    const volume = new GainNode(context, { gain: 0 });
    const from = context.currentTime + from_s;
    volume.gain.setValueAtTime(0, from);
    volume.gain.linearRampToValueAtTime(0.2, from + 0.02);
    volume.gain.exponentialRampToValueAtTime(0.001, from + LENGTH_S);
    tone.connect(volume).connect(context.destination);
    tone.start(from);
    tone.stop(from + LENGTH_S);
  }
}
