// Shows a replay: a canvas, the controls below it, and the list of events.
"use strict";
import { ballAt, elementsAt, lastBefore, partAt, scoreAt, velocityAt, withTimes } from "./flight.js";
import { COLOURS, drawBall, drawPart, drawStanding, fit, inMetres, line, placeOf, trailOf, viewOf } from "./drawing.js";

const TRAIL = 0.4; // seconds of the ball's way that are drawn
const JUMP = 1; // seconds by the arrow keys on the scene

const replay = withTimes(JSON.parse(document.getElementById("replay").textContent));
const find = (id) => document.getElementById(id);
const [canvas, clock, slider, speed, list, values] = ["scene", "clock", "time", "speed", "events", "values"].map(find);
const context = canvas.getContext("2d");
const standing = document.createElement("canvas"); // what stands, drawn where it changes only
const moving = new Set(replay.parts.map((part) => part.element));
let [now, playing, last, pointer, drawn] = [0, false, null, null, null];
let [view, elements] = [null, replay.elements];

const named = (index) => {
  const element = replay.elements[index];
  if (!element) return `ball ${index - replay.elements.length}`;
  return element.name || `${element.type} ${index}`;
};
const short = (number) => Number(number.toPrecision(6)).toString();

function resize() {
  const [left, bottom, right, top] = replay.bounds;
  const margin = 0.04 * Math.max(right - left, top - bottom) + replay.ball_radius;
  view = viewOf(replay.bounds, margin, canvas.parentElement.clientWidth, 0.72 * window.innerHeight);
  fit(view, canvas, standing);
  drawn = null;
  draw();
}

/** What has changed up to now is drawn anew only when there is more, or less, of it. */
function drawChanged() {
  const count = replay.changes.filter(([begin]) => begin <= now).length;
  if (count === drawn) return;
  drawn = count;
  elements = elementsAt(replay.elements, replay.changes, now);
  drawStanding(standing.getContext("2d"), view, elements, moving);
}

function draw() {
  drawChanged();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(standing, 0, 0);
  inMetres(context, view);
  for (const { element, paths } of replay.parts) drawPart(context, elements[element], partAt(paths, now));
  for (const paths of replay.balls) {
    drawBall(context, view, trailOf((time) => ballAt(paths, time), now, TRAIL), replay.ball_radius);
  }
  drawNormal();
  tell();
}

function drawNormal() {
  const event = replay.events[list.selectedIndex];
  if (!event || event[0] !== now || event[2] < 0) return;
  const [[x, y], [nx, ny]] = [ballAt(replay.balls[event[2]], now), event.slice(4, 6)];
  const [r, length] = [replay.ball_radius, (40 * view.ratio) / view.scale];
  context.strokeStyle = COLOURS.mark;
  line(context, [x - r * nx, y - r * ny], [x - r * nx + length * nx, y - r * ny + length * ny]);
}

function tell() {
  clock.textContent = `${now.toFixed(4)} s`;
  slider.value = String(now);
  slider.setAttribute("aria-valuetext", clock.textContent);
  const words = replay.score.length ? [`score: ${short(scoreAt(replay.score, now))}`] : [];
  replay.balls.forEach((paths, k) => {
    const [[x, y], [vx, vy]] = [ballAt(paths, now), velocityAt(paths, now)];
    words.push(`ball ${k}: ${short(x)}, ${short(y)} m; ${short(vx)}, ${short(vy)} m/s (${short(Math.hypot(vx, vy))})`);
  });
  if (replay.lost) words.push(`${replay.lost} events found no room in the recording and are missing`);
  if (pointer) words.push(`pointer: ${short(pointer[0])}, ${short(pointer[1])} m`);
  values.textContent = words.join("\n");
}

function go(time, index = null) {
  now = Math.min(Math.max(time, 0), replay.end);
  const found = index ?? (replay.events.length && replay.events[0][0] <= now ? lastBefore(replay.events, now) : -1);
  if (list.selectedIndex !== found) list.selectedIndex = found;
  draw();
}

function play(on) {
  if (on && now >= replay.end) now = 0;
  [playing, last] = [on, null];
  find("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(frame);
}

function frame(at) {
  if (!playing) return;
  if (last !== null) go(now + ((at - last) / 1000) * Number(speed.value));
  last = at;
  if (now >= replay.end) play(false);
  else requestAnimationFrame(frame);
}

function toEvent(index) {
  if (index < 0 || index >= replay.events.length) return;
  play(false);
  go(replay.events[index][0], index);
}

for (const [time, kind, ball, element, , , vx0, vy0] of replay.events) {
  const option = document.createElement("option");
  const after = ball < 0 ? null : velocityAt(replay.balls[ball], time);
  const speeds = after ? `  ${short(Math.hypot(vx0, vy0))} → ${short(Math.hypot(...after))} m/s` : "";
  option.textContent = `${time.toFixed(4)}  ${replay.kinds[kind]}  ${named(element)}${speeds}`;
  list.append(option);
}
const keys = {
  " ": () => play(!playing),
  ",": () => toEvent(list.selectedIndex - 1),
  ".": () => toEvent(list.selectedIndex + 1),
  ArrowLeft: () => go(now - JUMP * Number(speed.value)),
  ArrowRight: () => go(now + JUMP * Number(speed.value)),
};
slider.max = String(replay.end);
slider.addEventListener("input", () => { play(false); go(Number(slider.value)); });
list.addEventListener("input", () => toEvent(list.selectedIndex));
find("play").addEventListener("click", () => play(!playing));
find("back").addEventListener("click", () => toEvent(list.selectedIndex - 1));
find("forth").addEventListener("click", () => toEvent(list.selectedIndex + 1));
canvas.addEventListener("keydown", (event) => {
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});
canvas.addEventListener("pointermove", (event) => { pointer = placeOf(view, canvas, event); tell(); });
canvas.addEventListener("pointerleave", () => { pointer = null; tell(); });
window.addEventListener("resize", resize);
const { id, seed, episode } = replay.about;
const which = seed === null || seed === undefined ? "" : `, seed ${seed}${episode > 1 ? `, episode ${episode} of it` : ""}`;
find("title").textContent = id ? `${id}${which}` : "World";
resize();
go(Number(location.hash.slice(1)) || 0); // page.html#12.5 begins there
