// The tutorial's second example. The server plays the scene exactly; here it is drawn, dragged and asked on.
"use strict";
import { chartOf } from "./chart.js";
import { colourOf, COLOURS, disc, drawBall, drawPart, drawStanding, fit, inMetres, line, placeOf, viewOf } from "./drawing.js";
import { draggable } from "./handles.js";
import { fillFields, fillPalette, fillScenes, SCENE_FIELDS } from "./panel.js";
import { connect } from "./socket.js";

const NEAR = 18; // pixels from an end at which a pointer takes it
const TRAIL = 0.6; // seconds
const LONGEST = 0.05; // seconds that one frame may be behind

const find = (id) => document.getElementById(id);
const [board, canvas, list] = ["board", "canvas", "elements"].map(find);
const context = canvas.getContext("2d");
const standing = document.createElement("canvas"); // what stands, drawn where the scene changes only
const chart = chartOf(find("chart"));

let scene = null; // as the server has it
let now = null; // where everything is
let view = null;
let bounds = null;
let [playing, last, behind, asking] = [false, null, 0, false];
let drag = null; // { element, end, to, paused }
let aim = null; // { from, to } of a launch
let launched = null; // [place, velocity]
let trail = [];

const ask = connect("stage", take);
const size = () => Math.max(bounds[2] - bounds[0], bounds[3] - bounds[1]);

/** Show how things stand after an answer. */
function take(answer) {
  if (answer.line) find("line").textContent = answer.line;
  if (answer.builtin) fillScenes(find("scenes"), answer.builtin, answer.files);
  if (now && answer.time < now.time) [trail, launched] = [[], null];
  answer.parts = merged(answer);
  now = answer;
  launched ??= [answer.ball.slice(0, 2), answer.ball.slice(2)];
  for (const [time, , , x, y] of answer.events || []) trail.push([time, x, y]);
  trail.push([answer.time, answer.ball[0], answer.ball[1]]);
  while (trail.length > 1 && trail[0][0] < answer.time - TRAIL) trail.shift();
  chart.add(answer.time, answer.energy, answer.ghost?.error);
  if (answer.scene) {
    scene = answer.scene;
    bounds ??= answer.bounds;
    if (answer.builtin) bounds = answer.bounds;
    showScene(answer);
    resize();
  }
  find("undo").disabled = answer.undo === 0;
  draw();
}

/** Return where all parts are: an answer tells of those that have moved, or of all beside a scene. */
function merged({ scene: anew, parts }) {
  if (anew || !now) return parts;
  const moved = new Map(parts);
  return now.parts.map(([index, numbers]) => [index, moved.get(index) ?? numbers]);
}

function resize() {
  if (!bounds) return;
  view = viewOf(bounds, 0.05 * size(), board.clientWidth, 0.7 * window.innerHeight);
  fit(view, canvas, standing);
  const moving = new Set(now.parts.map(([index]) => index));
  drawStanding(standing.getContext("2d"), view, scene.elements, moving);
  placeHandles();
  draw();
}

function draw() {
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(standing, 0, 0);
  inMetres(context, view);
  for (const [index, numbers] of now.parts) {
    if (scene.elements[index].type !== "wall") drawPart(context, scene.elements[index], numbers);
    else drawWall(scene.elements[index], numbers, index === selected());
  }
  if (now.ghost?.position) {
    context.strokeStyle = COLOURS.mark;
    context.setLineDash([3 * context.lineWidth, 3 * context.lineWidth]);
    disc(context, now.ghost.position, Math.max(scene.ball.radius || 0, (6 * view.ratio) / view.scale), false);
    context.setLineDash([]);
  }
  drawTrail();
  drawBall(context, view, [now.ball], scene.ball.radius || 0);
  if (aim) {
    context.strokeStyle = COLOURS.mark;
    line(context, aim.from, aim.to);
  }
  placeHandles();
  tell();
  document.dispatchEvent(new CustomEvent("drawn", { detail: now }));
}

function drawWall(element, numbers, isSelected) {
  context.strokeStyle = isSelected ? COLOURS.mark : colourOf(element, scene.ball.b);
  line(context, numbers.slice(0, 2), numbers.slice(2));
}

function drawTrail() {
  context.strokeStyle = `rgba(${COLOURS.trail},0.6)`;
  context.beginPath();
  for (const [, x, y] of trail) context.lineTo(x, y);
  context.stroke();
}

function tell() {
  const words = [
    `time ${now.time.toFixed(4)} s    bounces ${now.bounces}    energy ${now.energy.toPrecision(8)} J/kg    speed ${Math.hypot(now.ball[2], now.ball[3]).toPrecision(5)} m/s`,
  ];
  if (now.status === "crushed") {
    words.push("CRUSHED: a wall has run over the ball, which had no room to give way. Drag the wall off it, or launch the ball anew.");
  } else if (now.status === "out") words.push("The ball has left through a drain: launch it anew.");
  else if (now.status !== "ok" && now.status !== "in_play") words.push(`The ball is ${now.status.replace("_", " ")}.`);
  if (now.ghost?.words) words.push(`No ghost: ${now.ghost.words}`);
  else if (now.ghost) words.push(`The tutorial's stepper is ${now.ghost.error.toPrecision(4)} m off.`);
  find("status").textContent = words.join("\n");
}

// Time

function play(on) {
  [playing, last, behind] = [on, null, 0];
  find("play").textContent = on ? "Pause" : "Play";
  if (on) requestAnimationFrame(frame);
}

function frame(at) {
  if (!playing) return;
  requestAnimationFrame(frame);
  advance(at);
}

/** Let the time pass that has gone by up to now [ms]; what there is no answer for yet is made up for later. */
function advance(at) {
  if (last !== null) behind = Math.min(behind + Math.max(at - last, 0) / 1000, LONGEST);
  last = Math.max(at, last ?? 0);
  if (asking) return;
  asking = true;
  const message = { do: "advance", seconds: behind * Number(find("speed").value) };
  behind = 0;
  if (drag) [message.drag, message.targets] = [drag.element, [0, 1].map((k) => (k === drag.end ? drag.to : null))];
  ask(message).then(() => (asking = false));
}

// Ends of walls

const endsOf = (index) => {
  const part = now.parts.find(([i]) => i === index);
  const element = scene.elements[index];
  if (part && element.type === "wall") return [part[1].slice(0, 2), part[1].slice(2)];
  if (element.start) return [element.start, element.end];
  return element.center || element.pivot ? [element.center || element.pivot] : [];
};

/** Return { element, end } of the end that is near to a place; null where none is. */
function endNear(place) {
  let [found, nearest] = [null, (NEAR * view.ratio) / view.scale];
  scene.elements.forEach((element, index) => {
    endsOf(index).forEach((end, k) => {
      const away = Math.hypot(end[0] - place[0], end[1] - place[1]);
      if (away < nearest) [found, nearest] = [{ element: index, end: k }, away];
    });
  });
  return found;
}

function beginDrag(element, end) {
  drag = { element, end, to: endsOf(element)[end], moved: false };
  ask({ do: "remember" });
}

function dragTo(place) {
  if (!drag) return;
  drag.to = place;
  const isWall = scene.elements[drag.element].type === "wall" && !scene.elements[drag.element].one_way;
  if (playing && isWall) return advance(performance.now()); // at once, and not only at the next frame
  if (asking) return void (drag.late = true);
  asking = true;
  jump(drag.element, drag.end, place).then(() => {
    asking = false;
    if (drag?.late) [drag.late] = [false, dragTo(drag.to)];
  });
}

/** Put a point of an element somewhere at once. */
function jump(index, end, place) {
  const element = scene.elements[index];
  if (element.type === "wall") return ask({ do: "place_end", element: index, end, to: place });
  const field = element.start ? ["start", "end"][end] : element.center ? "center" : "pivot";
  return ask({ do: "set", element: index, field, value: place });
}

function endDrag() {
  drag = null;
  draw();
}

canvas.addEventListener("pointerdown", (event) => {
  const place = placeOf(view, canvas, event);
  const near = endNear(place);
  const ball = now.ball;
  canvas.setPointerCapture(event.pointerId);
  if (near) {
    list.value = String(near.element);
    showSelected();
    beginDrag(near.element, near.end);
  } else if (Math.hypot(ball[0] - place[0], ball[1] - place[1]) < Math.max(scene.ball.radius || 0, (NEAR * view.ratio) / view.scale)) {
    aim = { from: ball.slice(0, 2), to: place };
  }
});
canvas.addEventListener("pointermove", (event) => {
  const place = placeOf(view, canvas, event);
  if (aim) {
    aim.to = place;
    draw();
  } else dragTo(place);
});
canvas.addEventListener("pointerup", () => {
  if (aim) launchFrom(aim.from, [2 * (aim.to[0] - aim.from[0]), 2 * (aim.to[1] - aim.from[1])]);
  aim = null;
  endDrag();
});
canvas.addEventListener("pointercancel", () => { aim = null; endDrag(); });

function launchFrom(position, velocity) {
  launched = null;
  ask({ do: "launch", position, velocity });
}

/** The selected element has a handle for each of its points, for the keyboard and for thick fingers. */
const handles = [0, 1].map((k) => {
  const handle = Object.assign(document.createElement("button"), { className: "handle", type: "button" });
  board.append(handle);
  draggable(handle, {
    placeOf: (event) => placeOf(view, canvas, event),
    here: () => endsOf(selected())[k],
    step: () => 0.01 * size(),
    began: () => beginDrag(selected(), k),
    moved: dragTo,
    ended: () => setTimeout(endDrag, playing ? 150 : 0), // a key's step has time to be gone
  });
  return handle;
});
const shade = Object.assign(document.createElement("div"), { className: "handle ghost", hidden: true });
board.append(shade);

function put(element, [x, y]) {
  const left = ((x - view.x) * view.scale) / view.ratio;
  const top = view.height - ((y - view.y) * view.scale) / view.ratio;
  Object.assign(element.style, { left: `${left}px`, top: `${top}px` });
}

function placeHandles() {
  const ends = selected() === null ? [] : endsOf(selected());
  handles.forEach((handle, k) => {
    handle.hidden = k >= ends.length;
    if (handle.hidden) return;
    put(handle, ends[k]);
    handle.setAttribute("aria-label", `${["Start", "End"][k]} of ${list.selectedOptions[0]?.textContent}: ${ends[k].map((v) => v.toFixed(3)).join(", ")}`);
  });
  shade.hidden = !drag;
  if (drag) put(shade, drag.to);
}

// The panel

const selected = () => (list.value === "" || !scene || Number(list.value) >= scene.elements.length ? null : Number(list.value));

function showScene({ needs }) {
  const kept = list.value;
  list.replaceChildren(...scene.elements.map((element, index) => new Option(`${index} ${element.name || element.type}`, index)));
  list.value = kept !== "" && Number(kept) < scene.elements.length ? kept : "0";
  fillFields(find("world"), SCENE_FIELDS(scene), (field, value) => ask({ do: "set", element: null, field, value }));
  find("needs").replaceChildren(...Object.entries(needs).map(([id, need]) => {
    const words = need ? need.replace(/^a scene for[^:]*: /, "") : "complete: save it, and copy the line";
    return Object.assign(document.createElement("li"), { textContent: `${id}: ${words}` });
  }));
  showSelected();
}

function showSelected() {
  const index = selected();
  const element = index === null ? {} : scene.elements[index];
  fillFields(find("fields"), element, (field, value) => ask({ do: "set", element: index, field, value }));
}

fillPalette(find("palette"), (make) => {
  const centre = [0.5 * (bounds[0] + bounds[2]), 0.5 * (bounds[1] + bounds[3])];
  ask({ do: "add", element: make(centre, size()) }).then(() => {
    list.value = String(scene.elements.length - 1);
    showSelected();
    draw();
  });
});

list.addEventListener("input", () => { showSelected(); draw(); });
find("remove").addEventListener("click", () => selected() !== null && ask({ do: "remove", element: selected() }));
find("play").addEventListener("click", () => play(!playing));
find("next").addEventListener("click", () => { play(false); ask({ do: "next" }); });
find("launch").addEventListener("click", () => launchFrom(...launched));
find("undo").addEventListener("click", () => ask({ do: "undo" }));
find("ghost").addEventListener("input", (event) => ask({ do: "ghost", on: event.target.checked }));
find("load").addEventListener("click", () => {
  const [kind, name] = find("scenes").value.split(":");
  chart.clear();
  ask({ do: "load", name, builtin: kind === "builtin" });
});
find("save").addEventListener("click", () => ask({ do: "save", name: find("name").value, overwrite: find("overwrite").checked }));

const FLIPPERS = { ArrowLeft: "left", ArrowRight: "right" };
function press(side, on) {
  scene.elements.forEach((element, index) => {
    if (element.type === "flipper" && element.name.includes(side)) ask({ do: "press", element: index, on });
  });
}
canvas.addEventListener("keydown", (event) => {
  if (event.key in FLIPPERS && !event.repeat) press(FLIPPERS[event.key], true);
  else if (event.key === " ") play(!playing);
  else if (event.key === ".") find("next").click();
  else if (!(event.key in FLIPPERS)) return;
  event.preventDefault();
});
canvas.addEventListener("keyup", (event) => event.key in FLIPPERS && press(FLIPPERS[event.key], false));

window.addEventListener("resize", resize);
ask({ do: "open" });
