// Where balls and parts are at an instant, from a replay's document (docs/replay.md). No drawing, no page.
"use strict";

/** Return a document with times [s] in place of their numbers: in all lists of rows, the first of a row. */
export function withTimes(document) {
  const at = document.instants;
  const timed = ([first, ...others]) => [at[first], ...others];
  const path = (row) => (row.length === 4 ? [at[row[0]], at[row[1]], row[2], row[3]] : timed(row));
  return {
    ...document,
    balls: document.balls.map((paths) => paths.map(path)),
    parts: document.parts.map((part) => ({ ...part, paths: part.paths.map(timed) })),
    changes: document.changes.map(timed),
    score: document.score.map(timed),
    events: document.events.map(timed),
  };
}

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

/** Return the slope of a Chebyshev series at u: c1 U0 + 2 c2 U1 + ..., with U the polynomials of the second kind. */
export function chebyshevSlope(series, u) {
  let b1 = 0;
  let b2 = 0;
  for (let k = series.length - 1; k > 1; k--) [b1, b2] = [k * series[k] + 2 * u * b1 - b2, b1];
  return series.length > 1 ? series[1] + 2 * u * b1 - b2 : 0;
}

/** Return where in its piece, from -1 to 1, an instant is. */
function shareOf([begin, end], time) {
  return Math.min(Math.max((2 * (time - begin)) / (end - begin) - 1, -1), 1);
}

/** Return the place [x, y] of a ball, of its paths, at an instant. */
export function ballAt(paths, time) {
  const path = paths[lastBefore(paths, time)];
  if (path.length === 4) {
    const u = shareOf(path, time);
    return [chebyshev(path[2], u), chebyshev(path[3], u)];
  }
  const [begin, x, y, vx, vy, ax, ay] = path;
  const t = time - begin;
  return [x + (vx + 0.5 * ax * t) * t, y + (vy + 0.5 * ay * t) * t];
}

/** Return the velocity [vx, vy] of a ball at an instant. */
export function velocityAt(paths, time) {
  const path = paths[lastBefore(paths, time)];
  if (path.length === 4) {
    const [u, rate] = [shareOf(path, time), 2 / (path[1] - path[0])];
    return [rate * chebyshevSlope(path[2], u), rate * chebyshevSlope(path[3], u)];
  }
  const t = time - path[0];
  return [path[3] + path[5] * t, path[4] + path[6] * t];
}

/** Return the numbers of a part at an instant: an angle, a centre or two ends. */
export function partAt(paths, time) {
  const [begin, place, rate] = paths[lastBefore(paths, time)];
  return place.map((number, i) => number + rate[i] * (time - begin));
}

/** Return the elements as they are at an instant: some are switched off, or put elsewhere, as a run goes on. */
export function elementsAt(elements, changes, time) {
  const now = elements.map((element) => ({ ...element }));
  for (const [begin, index, field, value] of changes) if (begin <= time) now[index][field] = value;
  return now;
}

/** Return the score at an instant. */
export function scoreAt(score, time) {
  return score.length && score[0][0] <= time ? score[lastBefore(score, time)][1] : 0;
}
