// How sure a robot is of its place, as an ellipse in metres.

/** Of a normal distribution in the plane 95 % are within so many standard deviations. */
const LIKELY = Math.sqrt(-2 * Math.log(0.05));

/** Of variances and covariance xx, xy, yy; `degrees` anticlockwise from x to the longer axis. */
export function likelyEllipse([xx = 0, xy = 0, yy = 0]: readonly number[]): { rx: number; ry: number; degrees: number } {
  const middle = (xx + yy) / 2;
  const apart = Math.hypot((xx - yy) / 2, xy);
  const radius = (variance: number) => LIKELY * Math.sqrt(Math.max(variance, 0));
  return {
    rx: radius(middle + apart),
    ry: radius(middle - apart),
    degrees: ((Math.atan2(2 * xy, xx - yy) / 2) * 180) / Math.PI,
  };
}
