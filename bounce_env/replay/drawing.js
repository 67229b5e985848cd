// Draws scenes, parts and balls on a canvas; lengths are metres, y points up.
"use strict";

export const COLOURS = {
  ground: "#0c0e1c", still: "#8a98c6", lively: "#ff5f84", moving: "#38dace", sensor: "#4e9c7e", drain: "#d4485a",
  field: "rgba(96,104,232,0.16)", ball: "#fffcf0", trail: "255,214,150", mark: "#ffd696",
};
const SMALLEST_BALL = 2.5; // pixels
const SPOTS = 40; // of a trail

/**
 * Return how a canvas of some width and at most some height [CSS pixels] shows a box [left, bottom, right, top].
 * A page that is hidden, or not laid out yet, has no width: it is drawn on one pixel until it gets one.
 */
export function viewOf([left, bottom, right, top], margin, width, height) {
  const [wide, high] = [right - left + 2 * margin, Math.max(top - bottom, 0.3 * (right - left)) + 2 * margin];
  const scale = Math.min(Math.max(width, 1) / wide, Math.max(height, 1) / high);
  const ratio = window.devicePixelRatio || 1;
  return { width: wide * scale, height: high * scale, scale: scale * ratio, x: left - margin, y: bottom - margin, ratio };
}

/** Give canvases the size of a view. */
export function fit(view, ...canvases) {
  for (const canvas of canvases) {
    canvas.style.width = `${view.width}px`;
    canvas.style.height = `${view.height}px`;
    [canvas.width, canvas.height] = [view.width, view.height].map((side) => Math.max(1, Math.round(side * view.ratio)));
  }
}

/** Return the place in the scene [m] of a pointer's event on a canvas. */
export function placeOf(view, canvas, event) {
  const box = canvas.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left, box.bottom - event.clientY];
  return [(x * view.ratio) / view.scale + view.x, (y * view.ratio) / view.scale + view.y];
}

/** Let a context draw in metres, with lines of some pixels. */
export function inMetres(target, view, pixels = 1.6) {
  const { scale, x, y } = view;
  target.setTransform(scale, 0, 0, -scale, -x * scale, target.canvas.height + y * scale);
  target.lineWidth = (pixels * view.ratio) / scale;
  target.lineCap = "round";
  target.setLineDash([]);
}

export function line(target, [x0, y0], [x1, y1]) {
  target.beginPath();
  target.moveTo(x0, y0);
  target.lineTo(x1, y1);
  target.stroke();
}

export function disc(target, [x, y], radius, fill) {
  target.beginPath();
  target.arc(x, y, radius, 0, 2 * Math.PI);
  if (fill) target.fill();
  else target.stroke();
}

/** Return the colour of an element that stands; ballB: of the ball, for a bounce adds speed where both b are more than 1. */
export function colourOf(element, ballB = 1) {
  if (element.type === "sensor" && element.drain) return element.center ? COLOURS.mark : COLOURS.drain; // a target, or out
  if (element.type === "sensor") return COLOURS.sensor;
  return ballB * (element.b ?? 1) > 1 || element.kick > 0 ? COLOURS.lively : COLOURS.still;
}

/** Draw the elements that stand, on the ground. moving: the indices of the others. */
export function drawStanding(target, view, elements, moving) {
  target.setTransform(1, 0, 0, 1, 0, 0);
  target.fillStyle = COLOURS.ground;
  target.fillRect(0, 0, target.canvas.width, target.canvas.height);
  inMetres(target, view);
  elements.forEach((element, index) => {
    if (!moving.has(index) && !element.disabled) drawElement(target, element);
  });
}

function drawElement(target, element) {
  const pixel = target.lineWidth;
  target.strokeStyle = colourOf(element);
  target.setLineDash(element.type === "sensor" ? [4 * pixel, 3 * pixel] : []);
  if (element.type === "field") {
    target.fillStyle = COLOURS.field;
    target.beginPath();
    element.points.forEach(([x, y]) => target.lineTo(x, y));
    target.fill();
  } else if (element.type === "arc") {
    target.beginPath();
    target.arc(...element.center, element.radius, element.start_angle, element.end_angle);
    target.stroke();
  } else if (element.center) disc(target, element.center, element.radius, false);
  else if (element.start) {
    line(target, element.start, element.end);
    if (element.one_way) drawOpenSide(target, element, 5 * pixel);
  }
}

/** A one-way wall stops a ball from its left only: ticks stand on that side. */
function drawOpenSide(target, { start, end }, length) {
  const [dx, dy] = [end[0] - start[0], end[1] - start[1]];
  const whole = Math.hypot(dx, dy);
  for (const share of [0.25, 0.5, 0.75]) {
    const [x, y] = [start[0] + share * dx, start[1] + share * dy];
    line(target, [x, y], [x - (length * dy) / whole, y + (length * dx) / whole]);
  }
}

/** Draw a part that moves where its numbers say: see `partAt`. */
export function drawPart(target, element, place) {
  if (element.disabled) return;
  target.strokeStyle = COLOURS.moving;
  if (place.length === 4) return void line(target, place.slice(0, 2), place.slice(2));
  const thin = target.lineWidth;
  if (place.length === 1) {
    const [x, y] = element.pivot;
    target.lineWidth = 2 * element.radius;
    line(target, [x, y], [x + element.length * Math.cos(place[0]), y + element.length * Math.sin(place[0])]);
  } else if (element.half_width !== undefined) {
    const [dx, dy] = [element.rail_end[0] - element.rail_start[0], element.rail_end[1] - element.rail_start[1]];
    const share = element.half_width / Math.hypot(dx, dy);
    target.lineWidth = 2 * element.radius;
    line(target, [place[0] - share * dx, place[1] - share * dy], [place[0] + share * dx, place[1] + share * dy]);
  } else disc(target, place, element.radius, false);
  target.lineWidth = thin;
}

/** Draw a ball where it is, and fading where it was. places: now, and before, one after the other. */
export function drawBall(target, view, places, radius) {
  const seen = Math.max(radius, (SMALLEST_BALL * view.ratio) / view.scale);
  for (let k = places.length - 1; k > 0; k--) {
    target.fillStyle = `rgba(${COLOURS.trail},${0.5 * (1 - k / places.length)})`;
    disc(target, places[k], 0.5 * seen, true);
  }
  target.fillStyle = COLOURS.ball;
  disc(target, places[0], seen, true);
}

/** Return the places of a ball, now and before, from a function of the time [s]. */
export function trailOf(placeAt, now, seconds) {
  const places = [];
  for (let k = 0; k < SPOTS; k++) if (k === 0 || now - (seconds * k) / SPOTS >= 0) places.push(placeAt(now - (seconds * k) / SPOTS));
  return places;
}
