// The moment of a run that is looked at stands in the address, so that a link leads others there.
import { useEffect } from "preact/hooks";
import type { Moment } from "./moment";

const KEY = "t";
const SETTLED_MS = 300;

/** The moment that an address names, in seconds of the run's clock; null for none. */
export function momentIn(search: string): number | null {
  const given = new URLSearchParams(search).get(KEY);
  const time = given === null || given.trim() === "" ? NaN : Number(given);
  return Number.isFinite(time) && time >= 0 ? time : null;
}

/** An address with a moment in it, to a tenth of a second; without one for null.
 *
 * What has happened at that moment has happened at the one in the address, which is never before it.
 */
export function withMoment(path: string, time: number | null): string {
  if (time === null) return path;
  const nearest = Math.round(time * 10);
  return `${path}?${KEY}=${((nearest / 10 < time ? nearest + 1 : nearest) / 10).toFixed(1)}`;
}

/** Go to the moment in the address once all was read; from then on the address tells the moment shown. */
export function useMomentInAddress(moment: Moment, read: boolean): void {
  const shown = moment.newest.value ? null : moment.time.value;
  const playing = moment.playing.value;
  useEffect(() => {
    const asked = momentIn(location.search);
    if (read && asked !== null) moment.goTo(asked);
  }, [read]);
  useEffect(() => {
    if (!read || playing) return;
    const tell = () => {
      const address = withMoment(location.pathname, shown);
      if (address !== location.pathname + location.search) history.replaceState(history.state, "", address);
    };
    // Whoever loads the page anew right after going back to the newest moment stays there.
    if (shown === null) return tell();
    // Browsers take few changes of the address at a time.
    const timer = window.setTimeout(tell, SETTLED_MS);
    return () => window.clearTimeout(timer);
  }, [read, shown, playing]);
}
