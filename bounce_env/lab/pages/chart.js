// Energy and the ghost's error over time, with uPlot (a global of its own script).
"use strict";

const EVERY = 250; // milliseconds between two pictures
const MOST = 2000; // points
const HEIGHT = 160;

/** Return { add(time, energy, error), clear() } of a chart in a box. */
export function chartOf(box) {
  let rows = [[], [], []];
  let [chart, drawn] = [null, 0];

  const options = () => ({
    width: Math.max(box.clientWidth, 200),
    height: HEIGHT,
    scales: { x: { time: false }, error: { distr: 3 } },
    cursor: { show: false },
    axes: [
      { label: "time [s]", size: 40, labelSize: 16, stroke: ink(), grid: { stroke: faint() } },
      { label: "energy [J/kg]", size: 60, labelSize: 16, stroke: ink(), grid: { stroke: faint() } },
      { label: "ghost [m]", scale: "error", side: 1, size: 60, labelSize: 16, stroke: ink(), grid: { show: false } },
    ],
    series: [
      {},
      { label: "energy", stroke: "#2a9d8f", width: 2 },
      { label: "error of the ghost", scale: "error", stroke: "#d1495b", width: 2, dash: [6, 4] },
    ],
    legend: { show: false },
  });
  const ink = () => getComputedStyle(box).color;
  const faint = () => "rgba(128,128,128,0.25)";

  return {
    add(time, energy, error) {
      if (rows[0].length && time < rows[0].at(-1)) this.clear();
      if (time === rows[0].at(-1)) return;
      rows[0].push(time);
      rows[1].push(energy);
      rows[2].push(error > 0 ? error : null);
      if (rows[0].length > MOST) rows = rows.map((column) => column.filter((_, i) => i % 2 === 0));
      if (performance.now() - drawn < EVERY) return;
      drawn = performance.now();
      chart ??= new window.uPlot(options(), rows, box);
      if (chart.width !== Math.max(box.clientWidth, 200)) chart.setSize({ width: Math.max(box.clientWidth, 200), height: HEIGHT });
      chart.setData(rows);
    },
    clear() {
      rows = [[], [], []];
    },
  };
}
