// What part of a run's time the timeline shows, and where in the drawing each time is.

export const SMALLEST_SPAN_S = 1;

/** Seconds of the run's clock. */
export interface Span {
  from: number;
  to: number;
}

/** From seconds to px and back. */
export interface Scale extends Span {
  left: number;
  width: number;
  x(time: number): number;
  time(x: number): number;
}

/** What a changed span is to keep in its middle: the moment shown, where it can be seen. */
export function middleOf(span: Span, time: number): number {
  return time >= span.from && time <= span.to ? time : (span.from + span.to) / 2;
}

/** A span by `factor` as long, as near to `around` as before; null is the whole run. */
export function zoomed(span: Span, factor: number, around: number, whole: Span): Span | null {
  const length = Math.max((span.to - span.from) * factor, SMALLEST_SPAN_S);
  if (length >= whole.to) return null;
  return within(around - ((around - span.from) / (span.to - span.from)) * length, length, whole);
}

/** A span of this length that begins at `from`, moved to where the run is. */
export function within(from: number, length: number, whole: Span): Span {
  const begin = Math.min(Math.max(from, 0), Math.max(whole.to - length, 0));
  return { from: begin, to: begin + length };
}

/** The scale of a drawing `full` px wide that begins at `left`. */
export function scaleOf(span: Span, left: number, full: number): Scale {
  const width = Math.max(full - left - 12, 1);
  const perSecond = width / (span.to - span.from);
  return {
    ...span,
    left,
    width,
    x: (time) => left + (time - span.from) * perSecond,
    time: (x) => span.from + (x - left) / perSecond,
  };
}
