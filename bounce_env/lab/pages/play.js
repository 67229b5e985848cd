// The games: the server plays them, frame by frame; here they are drawn, and keys, mouse and fingers are read.
"use strict";
import { COLOURS, disc, drawBall, drawPart, drawStanding, fit, inMetres, line, placeOf, viewOf } from "./drawing.js";
import { connect } from "./socket.js";

const FPS = 60;
const MOST = 6; // frames that one message plays
const GLOW = 150; // milliseconds for which what was struck lights up
const KEYS = { Shift: { 1: "left shift", 2: "right shift" }, ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };
const USED = new Set(["a", "d", "w", "s", "z", "x", "left", "right", "up", "down", "left shift", "right shift"]);

const find = (id) => document.getElementById(id);
const [board, canvas, words] = ["board", "canvas", "words"].map(find);
const context = canvas.getContext("2d");
const standing = document.createElement("canvas");
const held = new Set();
const struck = new Map(); // element -> until when it glows

let [scene, now, view, bounds] = [null, null, null, null];
let [waits, paused, asking, last, owed] = [true, false, false, null, 0];
let point = null; // { to, end } where a person points
let trail = [];

const ask = connect("play", take);
let best = null;
function take(answer) {
  if (answer.best !== undefined) best = answer.best;
  if (answer.controls) find("controls").textContent = `${answer.controls}. P: pause, R: new game, V: film. Mouse or finger: ${pointing()}.`;
  const jumped = !now || now.balls.length === 0;
  now = answer;
  if (answer.scene) {
    scene = answer.scene;
    bounds = answer.bounds;
    trail = [];
    resize();
  }
  if (jumped) trail = [];
  if (answer.balls.length) trail.unshift(answer.balls[0]);
  trail.length = Math.min(trail.length, 20);
  for (const index of answer.hits) struck.set(index, performance.now() + GLOW);
  if (answer.end) point = null;
  draw();
}

const pointing = () => ({
  pinball: "hold down left or right half for that flipper", paddle: "hold down, and the paddle follows",
  walls: "drag an end of the wall",
})[find("game").value];

function resize() {
  if (!bounds) return;
  const size = Math.max(bounds[2] - bounds[0], bounds[3] - bounds[1]);
  view = viewOf(bounds, 0.03 * size, board.parentElement.clientWidth - 32, 0.78 * window.innerHeight);
  fit(view, canvas, standing);
  drawStanding(standing.getContext("2d"), view, scene.elements, new Set(now.parts.map(([index]) => index)));
  draw();
}

function draw() {
  if (!view) return;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(standing, 0, 0);
  inMetres(context, view);
  now.lit.forEach(light);
  const time = performance.now();
  for (const [index, until] of struck) {
    if (until > time) light(index);
    else struck.delete(index);
  }
  for (const [index, numbers] of now.parts) drawPart(context, scene.elements[index], numbers);
  now.balls.forEach((ball, k) => drawBall(context, view, k === 0 && trail.length ? trail : [ball], scene.ball.radius));
  tell();
}

/** Let a standing element shine. */
function light(index) {
  const element = scene.elements[index];
  const thin = context.lineWidth;
  context.strokeStyle = COLOURS.mark;
  context.lineWidth = 3 * thin;
  if (element.type === "arc") {
    context.beginPath();
    context.arc(...element.center, element.radius, element.start_angle, element.end_angle);
    context.stroke();
  } else if (element.center && element.radius) disc(context, element.center, element.radius, false);
  else if (element.start) line(context, element.start, element.end);
  context.lineWidth = thin;
}

function tell() {
  const left = [`Score ${Number(now.score.toPrecision(6))}`, ...now.status];
  if (best !== null) left.push(`Best ${Number(best.toPrecision(6))}`);
  find("hud").textContent = left.join("    ");
  find("pause").setAttribute("aria-pressed", String(paused));
  find("film").setAttribute("aria-pressed", String(now.films));
  find("film").textContent = now.films ? "Stop filming" : "Film";
  if (now.end) words.textContent = `Game over: ${now.end.replace("_", " ")}\nScore ${Number(now.score.toPrecision(6))}\nR: play again`;
  else if (waits) words.textContent = "Press a key, click or touch to start";
  else words.textContent = paused ? "Paused\nP: go on" : "";
}

function frame(at) {
  requestAnimationFrame(frame);
  if (!now || waits || paused || now.end) return void (last = null);
  if (last !== null) owed = Math.min(owed + ((at - last) / 1000) * FPS, MOST);
  last = at;
  const frames = Math.floor(owed);
  if (asking || frames < 1) return;
  owed -= frames;
  asking = true;
  ask({ do: "step", frames, held: [...held], ...point }).then(() => (asking = false));
}

function begin() {
  [waits, paused, owed, best] = [true, false, 0, null];
  held.clear();
  const name = find("scene").value.trim();
  ask({ do: "begin", game: find("game").value, scene: name || null }).then(() => canvas.focus({ preventScroll: true }));
}

function again() {
  [waits, paused, owed] = [false, false, 0];
  ask({ do: "again" });
}

function pause() {
  if (!waits && now && !now.end) paused = !paused;
  draw();
}

/** Return the name that a key has in the window's controls. */
const nameOf = (event) => {
  const known = KEYS[event.key];
  return typeof known === "object" ? known[event.location] : known || event.key.toLowerCase();
};

canvas.addEventListener("keydown", (event) => {
  const name = nameOf(event);
  if (event.ctrlKey || event.metaKey || event.altKey || name === "tab") return;
  if (waits && now) {
    waits = false;
    tell();
  } else if (name === "p") pause();
  else if (name === "r") again();
  else if (name === "v") film();
  if (!USED.has(name)) return;
  event.preventDefault();
  held.add(name);
});
canvas.addEventListener("keyup", (event) => held.delete(nameOf(event)));
canvas.addEventListener("blur", () => held.clear());

// Pointers: several fingers may be down at once.
const fingers = new Map();
canvas.addEventListener("pointerdown", (event) => {
  event.preventDefault();
  canvas.focus({ preventScroll: true });
  canvas.setPointerCapture(event.pointerId);
  if (!now) return;
  if (now.end) return again();
  waits = false;
  fingers.set(event.pointerId, placeOf(view, canvas, event));
  pointAt(true);
});
canvas.addEventListener("pointermove", (event) => {
  if (!fingers.has(event.pointerId)) return;
  fingers.set(event.pointerId, placeOf(view, canvas, event));
  pointAt(false);
});
for (const kind of ["pointerup", "pointercancel"]) {
  canvas.addEventListener(kind, (event) => {
    fingers.delete(event.pointerId);
    pointAt(false);
  });
}

function pointAt(chooses) {
  const places = [...fingers.values()];
  if (find("game").value === "pinball") {
    const middle = 0.5 * (bounds[0] + bounds[2]);
    for (const [name, isDown] of [["left", places.some(([x]) => x < middle)], ["right", places.some(([x]) => x >= middle)]]) {
      if (isDown) held.add(name);
      else held.delete(name);
    }
    return;
  }
  if (!places.length) return void (point = null);
  const to = places.at(-1);
  point = { to, end: chooses || !point ? nearestEnd(to) : point.end };
}

function nearestEnd([x, y]) {
  const wall = now.parts.find(([, numbers]) => numbers.length === 4);
  if (!wall) return 0;
  const [x0, y0, x1, y1] = wall[1];
  return Math.hypot(x - x0, y - y0) <= Math.hypot(x - x1, y - y1) ? 0 : 1;
}

find("begin").addEventListener("click", begin);
find("game").addEventListener("input", begin);
find("pause").addEventListener("click", pause);
const film = () => now && ask({ do: "film", name: now.films ? null : find("name").value });
find("film").addEventListener("click", film);
find("save").addEventListener("click", () => now && ask({ do: "save", name: find("name").value }));
window.addEventListener("resize", resize);
requestAnimationFrame(frame);
begin();
