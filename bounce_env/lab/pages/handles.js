// Points that a person drags: by mouse, by finger, or with the arrow keys once they have the focus.
"use strict";

/**
 * Let an element be dragged.
 *
 * placeOf(event): where a pointer is, [x, y]. moved(place): the point goes there. step(): how far an arrow key goes.
 * here(): where the point is. began, ended: called around each drag by pointer, and each key.
 */
export function draggable(element, { placeOf, here, moved, step, began = () => {}, ended = () => {} }) {
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1] };
  let held = false;
  element.tabIndex = 0;
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    event.preventDefault();
    element.focus();
    element.setPointerCapture(event.pointerId);
    held = true;
    began();
  });
  element.addEventListener("pointermove", (event) => {
    if (held) moved(placeOf(event));
  });
  const release = () => {
    if (held) ended();
    held = false;
  };
  element.addEventListener("pointerup", release);
  element.addEventListener("pointercancel", release);
  element.addEventListener("lostpointercapture", release);
  element.addEventListener("keydown", (event) => {
    const way = arrows[event.key];
    if (!way) return;
    event.preventDefault();
    const far = step() * (event.shiftKey ? 10 : 1);
    const [x, y] = here();
    began();
    moved([x + way[0] * far, y + way[1] * far]);
    ended();
  });
}
