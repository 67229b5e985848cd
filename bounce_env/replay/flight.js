// Where balls and parts are at an instant, from a replay's document (docs/replay.md). No drawing, no page.
"use strict";

/** Return the index of the last item that begins at or before `time`; 0 where none does. */
export function lastBefore(items, time) {
  let low = 0;
  let high = items.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (items[middle][0] <= time) low = middle;
    else high = middle;
  }
  return low;
}

/** Return the value of a Chebyshev series at u, from -1 to 1, by Clenshaw's recurrence. */
export function chebyshev(series, u) {
  let b1 = 0;
  let b2 = 0;
  for (let k = series.length - 1; k > 0; k--) [b1, b2] = [series[k] + 2 * u * b1 - b2, b1];
  return series[0] + u * b1 - b2;
}

/** Return the place [x, y] of a ball, of its paths, at an instant. */
export function ballAt(paths, time) {
  const path = paths[lastBefore(paths, time)];
  if (path.length === 4) {
    const [begin, end, x, y] = path;
    const u = Math.min(Math.max((2 * (time - begin)) / (end - begin) - 1, -1), 1);
    return [chebyshev(x, u), chebyshev(y, u)];
  }
  const [begin, x, y, vx, vy, ax, ay] = path;
  const t = time - begin;
  return [x + (vx + 0.5 * ax * t) * t, y + (vy + 0.5 * ay * t) * t];
}

/** Return the velocity [vx, vy] of a ball at an instant. */
export function velocityAt(paths, time) {
  const path = paths[lastBefore(paths, time)];
  if (path.length === 4) {
    const h = Math.min(1e-6, 0.25 * (path[1] - path[0]));
    const [a, b] = [Math.max(time - h, path[0]), Math.min(time + h, path[1])];
    const [p, q] = [ballAt(paths, a), ballAt(paths, b)];
    return [(q[0] - p[0]) / (b - a), (q[1] - p[1]) / (b - a)];
  }
  const t = time - path[0];
  return [path[3] + path[5] * t, path[4] + path[6] * t];
}

/** Return the numbers of a part at an instant: an angle, a centre or two ends. */
export function partAt(paths, time) {
  const [begin, place, rate] = paths[lastBefore(paths, time)];
  return place.map((number, i) => number + rate[i] * (time - begin));
}
