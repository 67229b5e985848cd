// What can be added to a scene, for each game: fields as in a TOML file, in a scene of some size around a place.
"use strict";

export const PALETTE = {
  "any scene": {
    wall: ([x, y], s) => ({ type: "wall", start: [x - 0.12 * s, y], end: [x + 0.12 * s, y + 0.04 * s] }),
    "one-way wall": ([x, y], s) => ({ type: "wall", start: [x - 0.12 * s, y], end: [x + 0.12 * s, y], one_way: true }),
    bumper: ([x, y], s) => ({ type: "bumper", center: [x, y], radius: 0.05 * s, b: 1.2 }),
    arc: ([x, y], s) => ({ type: "arc", center: [x, y], radius: 0.12 * s, start_angle: 3.5, end_angle: 5.9 }),
    drain: ([x, y], s) => ({ type: "sensor", start: [x - 0.15 * s, y], end: [x + 0.15 * s, y], drain: true }),
    field: ([x, y], s) => ({ type: "field", points: box(x, y, 0.1 * s), acceleration: [0, 3 * s] }),
  },
  paddle: {
    paddle: ([x, y], s) => ({
      type: "paddle", name: "paddle", rail_start: [x - 0.25 * s, y], rail_end: [x + 0.25 * s, y],
      half_width: 0.06 * s, radius: 0.015 * s, max_speed: 1.5 * s,
    }),
  },
  pinball: {
    "left flipper": ([x, y], s) => flipper("flipper_left", x - 0.12 * s, y, s, [-0.5, 0.5]),
    "right flipper": ([x, y], s) => flipper("flipper_right", x + 0.12 * s, y, s, [Math.PI + 0.5, Math.PI - 0.5]),
    plunger: ([x, y], s) => ({ type: "sensor", name: "plunger", center: [x, y], radius: 0.02 * s }),
    "in play": ([x, y], s) => ({ type: "sensor", name: "in_play", start: [x - 0.05 * s, y], end: [x + 0.05 * s, y] }),
  },
  walls: {
    "the player's wall": ([x, y], s) => ({ type: "wall", name: "wall", start: [x - 0.1 * s, y], end: [x + 0.1 * s, y], draggable: true }),
    target: ([x, y], s) => ({ type: "sensor", name: "target", center: [x, y], radius: 0.06 * s, drain: true }),
  },
};

function box(x, y, h) {
  return [[x - h, y - h], [x + h, y - h], [x + h, y + h], [x - h, y + h]];
}

function flipper(name, x, y, s, [rest_angle, active_angle]) {
  return {
    type: "flipper", name, pivot: [x, y], length: 0.1 * s, radius: 0.012 * s, rest_angle, active_angle, up_speed: 20, down_speed: 10,
  };
}
