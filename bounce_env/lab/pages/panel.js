// Fields of elements, the palette and the list of scenes: native controls, filled from what the server says.
"use strict";
import { PALETTE } from "./palette.js";

/** Return the fields of a scene that are changed beside its elements, by the names that the server knows. */
export const SCENE_FIELDS = (scene) => ({
  gravity: scene.gravity, "ball.radius": scene.ball.radius, "ball.b": scene.ball.b, "ball.f": scene.ball.f,
  max_speed: scene.max_speed ?? null,
});

/** Fill a box with a control for each field; changed(field, value) is called with what a person has entered. */
export function fillFields(box, fields, changed) {
  if (box.contains(document.activeElement) && box.dataset.fields === Object.keys(fields).join()) return;
  box.dataset.fields = Object.keys(fields).join();
  box.replaceChildren();
  for (const [field, value] of Object.entries(fields)) {
    if (field === "type") continue;
    for (const control of controlsFor(field, value, (entered) => changed(field, entered))) box.append(control);
  }
}

function controlsFor(field, value, changed) {
  const isPair = Array.isArray(value) && value.length === 2 && value.every((number) => typeof number === "number");
  if (isPair) {
    return value.map((number, k) =>
      labelled(`${field} ${"xy"[k]}`, numberInput(number, (entered) => changed(value.map((old, i) => (i === k ? entered : old))))),
    );
  }
  if (typeof value === "number" || value === null) return [labelled(field, numberInput(value, changed))];
  if (typeof value === "string") {
    const input = Object.assign(document.createElement("input"), { type: "text", value });
    input.addEventListener("change", () => changed(input.value));
    return [labelled(field, input)];
  }
  if (typeof value === "boolean") {
    const input = Object.assign(document.createElement("input"), { type: "checkbox", checked: value });
    input.addEventListener("input", () => changed(input.checked));
    return [labelled(field, input)];
  }
  return []; // lists of points are changed in the file
}

function numberInput(value, changed) {
  const input = Object.assign(document.createElement("input"), { type: "number", step: "any" });
  input.value = value === null ? "" : String(Number(value.toPrecision(8)));
  input.addEventListener("change", () => changed(input.value === "" ? null : Number(input.value)));
  return input;
}

function labelled(words, control) {
  const label = document.createElement("label");
  label.append(words, control);
  return label;
}

/** Fill the palette with a list to choose from for each game. add(make): what was chosen. */
export function fillPalette(box, add) {
  const select = document.createElement("select");
  select.setAttribute("aria-label", "What to add");
  for (const [game, templates] of Object.entries(PALETTE)) {
    const group = Object.assign(document.createElement("optgroup"), { label: game });
    for (const name of Object.keys(templates)) group.append(new Option(name, `${game}:${name}`));
    select.append(group);
  }
  const button = Object.assign(document.createElement("button"), { textContent: "Add", className: "secondary" });
  button.addEventListener("click", () => {
    const [game, name] = select.value.split(":");
    add(PALETTE[game][name]);
  });
  box.append(select, button);
}

/** Fill the list of scenes that can be loaded. */
export function fillScenes(select, builtin, files) {
  const groups = [["In the folder", "file", files], ["Built in", "builtin", builtin]];
  select.replaceChildren(...groups.filter(([, , names]) => names.length).map(([label, kind, names]) => {
    const group = Object.assign(document.createElement("optgroup"), { label });
    group.append(...names.map((name) => new Option(name, `${kind}:${name}`)));
    return group;
  }));
}
