// Shows a replay: a canvas, the controls below it, and the list of events.
"use strict";
import { ballAt, lastBefore, partAt, velocityAt } from "./flight.js";

const TRAIL = 0.4; // seconds of the ball's way that are drawn
const COLOURS = {
  ground: "#0c0e1c", still: "#8a98c6", lively: "#ff5f84", moving: "#38dace", sensor: "#4e9c7e", drain: "#d4485a",
  field: "rgba(96,104,232,0.16)", ball: "#fffcf0", trail: "255,214,150", mark: "#ffd696",
};

const replay = JSON.parse(document.getElementById("replay").textContent);
const find = (id) => document.getElementById(id);
const [canvas, clock, slider, speed, list, values] = ["scene", "clock", "time", "speed", "events", "values"].map(find);
const context = canvas.getContext("2d");
const still = document.createElement("canvas"); // what never moves, drawn once
let [now, playing, last, pointer] = [0, false, null, null];
let view = { scale: 1, x: 0, y: 0 };

const named = (index) => {
  const element = replay.elements[index];
  if (!element) return `ball ${index - replay.elements.length}`;
  return element.name || `${element.type} ${index}`;
};
const short = (number) => Number(number.toPrecision(6)).toString();

function resize() {
  const ratio = window.devicePixelRatio || 1;
  const [left, bottom, right, top] = replay.bounds;
  const margin = 0.04 * Math.max(right - left, top - bottom) + replay.ball_radius;
  const [wide, high] = [right - left + 2 * margin, Math.max(top - bottom, 0.3 * (right - left)) + 2 * margin];
  const width = canvas.parentElement.clientWidth;
  const scale = Math.min(width / wide, (0.72 * window.innerHeight) / high);
  canvas.style.width = `${wide * scale}px`;
  canvas.style.height = `${high * scale}px`;
  for (const each of [canvas, still]) [each.width, each.height] = [wide * scale * ratio, high * scale * ratio];
  view = { scale: scale * ratio, x: left - margin, y: bottom - margin };
  drawStill();
  draw();
}

function transform(target) {
  target.setTransform(view.scale, 0, 0, -view.scale, -view.x * view.scale, target.canvas.height + view.y * view.scale);
  target.lineWidth = 1.6 / view.scale * (window.devicePixelRatio || 1);
  target.lineCap = "round";
}

function colourOf(element) {
  if (element.type === "sensor") return element.drain ? COLOURS.drain : COLOURS.sensor;
  return element.b > 1 || element.kick > 0 ? COLOURS.lively : COLOURS.still;
}

function line(target, [x0, y0], [x1, y1]) {
  target.beginPath();
  target.moveTo(x0, y0);
  target.lineTo(x1, y1);
  target.stroke();
}

function disc(target, [x, y], radius, fill) {
  target.beginPath();
  target.arc(x, y, radius, 0, 2 * Math.PI);
  fill ? target.fill() : target.stroke();
}

function drawStill() {
  const target = still.getContext("2d");
  target.setTransform(1, 0, 0, 1, 0, 0);
  target.fillStyle = COLOURS.ground;
  target.fillRect(0, 0, still.width, still.height);
  transform(target);
  const moving = new Set(replay.parts.map((part) => part.element));
  replay.elements.forEach((element, index) => {
    if (moving.has(index)) return;
    target.strokeStyle = target.fillStyle = colourOf(element);
    target.setLineDash(element.type === "sensor" ? [4 * target.lineWidth, 3 * target.lineWidth] : []);
    if (element.type === "field") {
      target.fillStyle = COLOURS.field;
      target.beginPath();
      element.corners.forEach(([x, y]) => target.lineTo(x, y));
      target.fill();
    } else if (element.type === "arc") {
      target.beginPath();
      target.arc(...element.center, element.radius, element.start_angle, element.end_angle);
      target.stroke();
    } else if (element.center) disc(target, element.center, element.radius, false);
    else if (element.start) line(target, element.start, element.end);
  });
}

function drawPart({ element: index, paths }) {
  const [element, place] = [replay.elements[index], partAt(paths, now)];
  context.strokeStyle = COLOURS.moving;
  if (place.length === 4) return line(context, place.slice(0, 2), place.slice(2));
  const kept = context.lineWidth;
  if (place.length === 1) {
    const [x, y] = element.pivot;
    context.lineWidth = 2 * element.radius;
    line(context, [x, y], [x + element.length * Math.cos(place[0]), y + element.length * Math.sin(place[0])]);
  } else if (element.half_width !== undefined) {
    const [dx, dy] = [element.rail_end[0] - element.rail_start[0], element.rail_end[1] - element.rail_start[1]];
    const share = element.half_width / Math.hypot(dx, dy);
    context.lineWidth = 2 * element.radius;
    line(context, [place[0] - share * dx, place[1] - share * dy], [place[0] + share * dx, place[1] + share * dy]);
  } else disc(context, place, element.radius, false);
  context.lineWidth = kept;
}

function draw() {
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(still, 0, 0);
  transform(context);
  replay.parts.forEach(drawPart);
  const radius = Math.max(replay.ball_radius, 2.5 / view.scale);
  for (const paths of replay.balls) {
    for (let k = 40; k > 0; k--) {
      const then = now - (TRAIL * k) / 40;
      if (then < 0) continue;
      context.fillStyle = `rgba(${COLOURS.trail},${0.5 * (1 - k / 40)})`;
      disc(context, ballAt(paths, then), 0.5 * radius, true);
    }
    context.fillStyle = COLOURS.ball;
    disc(context, ballAt(paths, now), radius, true);
  }
  drawNormal();
  tell();
}

function drawNormal() {
  const event = replay.events[list.selectedIndex];
  if (!event || event[0] !== now || event[2] < 0) return;
  const [x, y, nx, ny] = event.slice(4, 8);
  const [r, length] = [replay.ball_radius, 40 / view.scale];
  context.strokeStyle = COLOURS.mark;
  line(context, [x - r * nx, y - r * ny], [x - r * nx + length * nx, y - r * ny + length * ny]);
}

function tell() {
  clock.textContent = `${now.toFixed(4)} s`;
  slider.value = String(now);
  slider.setAttribute("aria-valuetext", clock.textContent);
  const words = replay.balls.map((paths, k) => {
    const [[x, y], [vx, vy]] = [ballAt(paths, now), velocityAt(paths, now)];
    return `ball ${k}: ${short(x)}, ${short(y)} m; ${short(vx)}, ${short(vy)} m/s (${short(Math.hypot(vx, vy))})`;
  });
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

for (const [time, kind, ball, element, , , , , vx0, vy0, vx1, vy1] of replay.events) {
  const option = document.createElement("option");
  const speeds = ball < 0 ? "" : `  ${short(Math.hypot(vx0, vy0))} → ${short(Math.hypot(vx1, vy1))} m/s`;
  option.textContent = `${time.toFixed(4)}  ${replay.kinds[kind]}  ${named(element)}${speeds}`;
  list.append(option);
}
slider.max = String(replay.end);
slider.addEventListener("input", () => { play(false); go(Number(slider.value)); });
list.addEventListener("input", () => toEvent(list.selectedIndex));
find("play").addEventListener("click", () => play(!playing));
find("back").addEventListener("click", () => toEvent(list.selectedIndex - 1));
find("forth").addEventListener("click", () => toEvent(list.selectedIndex + 1));
canvas.addEventListener("pointermove", (event) => {
  const ratio = window.devicePixelRatio || 1;
  pointer = [(event.offsetX * ratio) / view.scale + view.x, (canvas.height - event.offsetY * ratio) / view.scale + view.y];
  tell();
});
canvas.addEventListener("pointerleave", () => { pointer = null; tell(); });
window.addEventListener("resize", resize);
find("title").textContent = replay.about.id ? `${replay.about.id}, seed ${replay.about.seed}` : "World";
resize();
go(0);
