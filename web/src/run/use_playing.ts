// While the past is played, time passes with the frames that are drawn.
import { useEffect } from "preact/hooks";
import type { Moment } from "./moment";

export function usePlaying(moment: Moment): void {
  const playing = moment.playing.value;
  useEffect(() => {
    if (!playing) return;
    let before = performance.now();
    let frame = 0;
    const pass = (now: number) => {
      moment.advance((now - before) / 1000);
      before = now;
      frame = requestAnimationFrame(pass);
    };
    frame = requestAnimationFrame(pass);
    return () => cancelAnimationFrame(frame);
  }, [moment, playing]);
}
