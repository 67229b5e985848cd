// The tutorial's first example. All numbers come from the server; here they are drawn and put into words.
"use strict";
import { connect } from "./socket.js";
import { draggable } from "./handles.js";

const SVG = "http://www.w3.org/2000/svg";
const find = (id) => document.getElementById(id);
const [board, drawing, labels, grips, numbers] = ["board", "drawing", "labels", "grips", "numbers"].map(find);
const FIELDS = ["movement_b", "movement_f", "wall_b", "wall_f", "radius"];
const STEP = 0.05;
const UNIT = 100; // of the picture, to a metre

const ends = { movement: [[-2.6, 2.2], [0.9, -1.6]], wall: [[-4.5, -1.6], [4.5, -0.6]] };
let [answer, asking, again] = [null, false, false];

const ask = connect("reflection", (found) => {
  answer = found;
  show();
});

async function update() {
  if (asking) return void (again = true);
  asking = true;
  do {
    again = false;
    const values = Object.fromEntries(FIELDS.map((name) => [name, Number(find(name).value)]));
    await ask({ do: "reflect", ...ends, ...values });
  } while (again);
  asking = false;
}

function make(parent, name, attributes) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

function arrow([x1, y1], [x2, y2], colour, more = {}) {
  return make(drawing, "line", { x1, y1, x2, y2, stroke: colour, "stroke-width": 0.05, "stroke-linecap": "round", ...more });
}

function word(text, [x, y], colour) {
  [x, y] = [Math.min(Math.max(x, -5.9), 3.8), Math.min(Math.max(y, -3.8), 3.7)]; // where it can be read
  make(labels, "text", { x: UNIT * x, y: -UNIT * y, fill: colour }).textContent = text;
}

const plus = ([x, y], [dx, dy], share = 1) => [x + share * dx, y + share * dy];
const middle = ([x0, y0], [x1, y1], share = 0.5) => [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];

function show() {
  drawing.replaceChildren();
  labels.replaceChildren();
  const [red, green, black, blue] = ["#c00000", "#006b1b", "#000000", "#0033cc"];
  const { v2, proj1, proj2, new: after, ip, end } = answer;
  const [from, to] = ends.movement;
  const radius = Number(find("radius").value);
  arrow(...ends.wall, green, { "stroke-width": 0.08 });
  word("v2, wall", plus(middle(...ends.wall, 0.86), [0, -0.45]), green);
  const foot = middle(...ends.wall);
  const normal = [v2.lx / v2.len, v2.ly / v2.len];
  arrow(foot, plus(foot, normal, 1.5), black, { "stroke-dasharray": "0.15 0.12", "marker-end": "url(#tip-black)" });
  word("normal", plus(foot, normal, 1.75), black);
  const meet = ip || to;
  const thick = { "stroke-width": 0.16, opacity: 0.45, "stroke-linecap": "butt" };
  arrow(meet, plus(meet, proj1, -1), red, thick);
  arrow(meet, plus(meet, proj2, -1), red, thick);
  arrow(from, to, red, { "marker-end": "url(#tip-red)" });
  word("v1, movement", plus(from, [0.2, 0.25]), red);
  const [k1, k2] = [factor("f"), factor("b")];
  arrow(meet, plus(meet, proj1, k1), blue, { ...thick, "stroke-dasharray": "0.12 0.08" });
  arrow(meet, plus(meet, proj2, -k2), blue, { ...thick, "stroke-dasharray": "0.12 0.08" });
  arrow(meet, plus(meet, after), blue, { "marker-end": "url(#tip-blue)" });
  word("new movement", plus(plus(meet, after), [0.15, 0.1]), blue);
  for (const [place, colour] of [[from, red], [meet, blue], [end || to, blue]]) {
    if (radius > 0) make(drawing, "circle", { cx: place[0], cy: place[1], r: radius, fill: "none", stroke: colour, "stroke-width": 0.03 });
  }
  if (end) make(drawing, "circle", { cx: end[0], cy: end[1], r: 0.09, fill: blue });
  place();
  tell();
}

const factor = (name) => Number(find(`movement_${name}`).value) * Number(find(`wall_${name}`).value);
const n = (value) => Number(value.toPrecision(6)).toString().replace("-", "−");
const pair = ([x, y]) => `(${n(x)}, ${n(y)})`;

function tell() {
  const { v1, v2, dp1, dp2, proj1, proj2, new: after, new_len, new_angle, printed, share, ip, rest } = answer;
  const [f, b] = [factor("f"), factor("b")];
  const rows = [
    ["v1 = p1 − p0", "", `${pair([v1.vx, v1.vy])}, length ${n(v1.len)}, ${n(v1.angle)}°`],
    ["v2 = p1 − p0", "", `${pair([v2.vx, v2.vy])}, length ${n(v2.len)}, ${n(v2.angle)}°`],
    ["v2.dx, v2.dy = v2 / v2.len", `${pair([v2.vx, v2.vy])} / ${n(v2.len)}`, pair([v2.dx, v2.dy])],
    ["v2.lx, v2.ly = v2.vy, −v2.vx", "", pair([v2.lx, v2.ly])],
    ["dp1 = v1.vx·v2.dx + v1.vy·v2.dy", `${n(v1.vx)}·${n(v2.dx)} + ${n(v1.vy)}·${n(v2.dy)}`, n(dp1)],
    ["proj1 = dp1·(v2.dx, v2.dy)", `${n(dp1)}·${pair([v2.dx, v2.dy])}`, pair(proj1)],
    ["dp2 = v1·(v2.lx, v2.ly) / v2.len", `${n(v1.vx)}·${n(v2.lx / v2.len)} + ${n(v1.vy)}·${n(v2.ly / v2.len)}`, n(dp2)],
    ["proj2 = dp2·(v2.lx, v2.ly) / v2.len", `${n(dp2)}·${pair([v2.lx / v2.len, v2.ly / v2.len])}`, pair(proj2)],
    ["proj2 reversed", `−1·${pair(proj2)}`, pair([-proj2[0], -proj2[1]])],
    ["v1 = v1.f·v2.f·proj1 + v1.b·v2.b·proj2", `${n(f)}·${pair(proj1)} + ${n(b)}·${pair([-proj2[0], -proj2[1]])}`, `${pair(after)}, length ${n(new_len)}, ${n(new_angle)}°`],
    ["where they meet", ip ? `after ${n(share)} of v1, ${n(rest)} is left` : "", ip ? pair(ip) : "v1 does not meet the wall"],
  ];
  numbers.replaceChildren(...rows.map((cells) => {
    const row = document.createElement("tr");
    row.append(...cells.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
    return row;
  }));
  find("erratum").textContent =
    `In print dp1 and dp2 are of v2 itself, not of its direction, so that the wall's length is in the result: with b and f of 1, ` +
    `${pair(printed)}, which is ${n(v2.len)} times as long. Here both use the direction.`;
}

const made = [];
for (const [name, words] of [["movement", "Movement"], ["wall", "Wall"]]) {
  for (const k of [0, 1]) {
    const grip = make(grips, "circle", { class: "grip", r: 26, role: "button" });
    made.push([grip, name, k, `${words}, ${k ? "end" : "start"}`]);
    draggable(grip, {
      placeOf: (event) => {
        const box = board.getBoundingClientRect();
        return [((event.clientX - box.left) / box.width) * 12 - 6, 4 - ((event.clientY - box.top) / box.height) * 8];
      },
      here: () => ends[name][k],
      step: () => STEP,
      moved: ([x, y]) => {
        ends[name][k] = [Math.min(Math.max(x, -5.8), 5.8), Math.min(Math.max(y, -3.8), 3.8)];
        place();
        update();
      },
    });
  }
}

function place() {
  for (const [grip, name, k, words] of made) {
    const [x, y] = ends[name][k];
    grip.setAttribute("cx", UNIT * x);
    grip.setAttribute("cy", -UNIT * y);
    grip.setAttribute("aria-label", `${words}: ${x.toFixed(2)}, ${y.toFixed(2)}`);
  }
}

for (const name of FIELDS) find(name).addEventListener("input", update);
place();
update();
