import type { Clock } from "./clock";
import { Plot, type PlotOptions, type Series } from "./plots";
import { Status, type Run } from "./run";

const g = 9.81;

type Axis = Pick<PlotOptions, "now" | "seek" | "group" | "xName">;

function overTime(run: Run, clock: Clock): Axis {
  return {
    now: () => run.timeAt(clock.moment),
    seek: (t) => {
      clock.pause();
      clock.seek(run.momentAtTime(t));
    },
    group: "time",
    xName: "run time (s)",
  };
}

function overSteps(run: Run, clock: Clock): Axis {
  return {
    now: () => run.stepAt(clock.moment),
    seek: (step) => {
      clock.pause();
      clock.seek(run.momentAtStep(step));
    },
    group: "step",
    xName: "step",
  };
}

/** a_x and a_y of all shaken stages, with gaps between them, on one scale. */
export function motionPlots(run: Run, clock: Clock): Plot[] {
  const time: number[] = [];
  const ax: (number | null)[] = [];
  const ay: (number | null)[] = [];
  let largest = 0;
  run.stages.forEach((_, k) => {
    if (!run.arrays.has(`motion.${k}.time`)) return;
    const t = run.arrays.get(`motion.${k}.time`, "f64");
    const x = run.arrays.get(`motion.${k}.x`, "f32");
    const y = run.arrays.get(`motion.${k}.y`, "f32");
    if (time.length > 0) {
      time.push(time[time.length - 1]);
      ax.push(null);
      ay.push(null);
    }
    for (let i = 0; i < t.length; i++) {
      time.push(t[i]);
      ax.push(x[i]);
      ay.push(y[i]);
      largest = Math.max(largest, Math.abs(x[i]), Math.abs(y[i]));
    }
  });
  if (time.length === 0) return [];
  // As wide in time as the run, so that plots above each other can be compared.
  const frames = run.frameCount;
  if (frames > 0 && run.time[0] < time[0]) {
    time.unshift(run.time[0]);
    ax.unshift(null);
    ay.unshift(null);
  }
  if (frames > 0 && run.time[frames - 1] > time[time.length - 1]) {
    time.push(run.time[frames - 1]);
    ax.push(null);
    ay.push(null);
  }
  const limit = 1.08 * (largest || 1);
  const plot = (title: string, symbol: string, values: (number | null)[], color: string) =>
    new Plot(
      {
        ...overTime(run, clock),
        title,
        unit: `${symbol} in m/s², right axis in g`,
        x: time,
        series: [{ name: title, values, color, width: 0.9 }],
        range: [-limit, limit],
        right: { divisor: g },
        height: 230,
      },
      clock,
    );
  return [
    plot("Horizontal acceleration", "a_x", ax, "--curve-1"),
    plot("Vertical acceleration", "a_y", ay, "--curve-2"),
  ];
}

/** Area of the fallen and of the loosened blocks over time. */
export function damagePlots(run: Run, clock: Clock): Plot[] {
  if (run.header.model.excavations.length === 0 || run.frameCount < 2) return [];
  if (run.time[run.frameCount - 1] <= run.time[0]) return [];
  const areas = (status: Status) =>
    Float32Array.from(run.time, (_, f) => {
      let sum = 0;
      for (let b = 0; b < run.blockCount; b++) if (run.statusAt(f, b) === status) sum += run.area[b];
      return sum;
    });
  return [
    new Plot(
      {
        ...overTime(run, clock),
        title: "Area of blocks",
        unit: "m²",
        x: run.time,
        series: [
          { name: "fallen", values: areas(Status.fallen), color: "--curve-2", width: 1.6 },
          { name: "loosened", values: areas(Status.loosened), color: "--curve-1", width: 1.6 },
        ],
        height: 200,
        rightSpace: true,
      },
      clock,
    ),
  ];
}

/** How many values each chosen point has: ux, uy, vx, vy, sxx, syy, sxy, ax, ay. */
const historyValues = 9;
/** How many each element has: force, elongation. */
const elementHistoryValues = 2;

/** Displacement, velocity, acceleration and stress of each chosen point. */
export function historyPlots(run: Run, clock: Clock): { name: string; plots: Plot[] }[] {
  const names = run.header.model.histories;
  const time = run.arrays.get("history.time", "f64");
  const rows = time.length;
  const followed = run.header.model.element_histories ?? [];
  if (names.length + followed.length === 0 || rows === 0) return [];
  const values = run.arrays.get("history.values", "f32");
  const column = (point: number, c: number) =>
    values.subarray((1 + historyValues * point + c) * rows, (2 + historyValues * point + c) * rows);
  // A static run takes no time: it is plotted over its steps.
  const isStatic = time[rows - 1] <= time[0];
  const x = isStatic ? Float64Array.from(values.subarray(0, rows)) : time;
  const axis = isStatic ? overSteps(run, clock) : overTime(run, clock);
  const ofElements = followed.map(({ name, element }, k) => {
    const first = 1 + historyValues * names.length + elementHistoryValues * k;
    const line = (label: string, c: number, factor: number): Series => ({
      name: label,
      values: Array.from(values.subarray((first + c) * rows, (first + c + 1) * rows), (v) =>
        Number.isNaN(v) ? null : factor * v,
      ),
      color: `--curve-${c + 1}`,
    });
    const plot = (title: string, unit: string, series: Series) =>
      new Plot({ ...axis, title, unit, x, series: [series] }, clock);
    const of = run.header.model.elements?.[element];
    return {
      name: of && of.name !== name ? `${name} (${of.kind} ${of.name})` : name,
      plots: [
        plot("Force", "kN/m", line("force", 0, 1e-3)),
        plot("Elongation", "mm", line("elongation", 1, 1e3)),
      ],
    };
  });
  const ofPoints = names.map((name, p) => {
    const inMetres = [0, 1].some((c) => column(p, c).some((u) => Math.abs(u) >= 1));
    const plot = (title: string, unit: string, series: Series[]) =>
      new Plot({ ...axis, title, unit, x, series }, clock);
    const line = (label: string, c: number, factor: number, k: number): Series => ({
      name: label,
      // Without a value once the block is excavated.
      values: Array.from(column(p, c), (v) => (Number.isNaN(v) ? null : factor * v)),
      color: `--curve-${k}`,
    });
    const length = inMetres ? 1 : 1e3;
    return {
      name,
      plots: [
        plot("Displacement", inMetres ? "m" : "mm", [line("u_x", 0, length, 1), line("u_y", 1, length, 2)]),
        plot("Velocity", "m/s", [line("v_x", 2, 1, 1), line("v_y", 3, 1, 2)]),
        // A static run has none, nor have results of earlier versions.
        ...(isStatic || column(p, 7).every(Number.isNaN)
          ? []
          : [plot("Acceleration", "m/s²", [line("a_x", 7, 1, 1), line("a_y", 8, 1, 2)])]),
        plot("Stress", "kPa, compression negative", [
          line("σ_xx", 4, 1e-3, 1),
          line("σ_yy", 5, 1e-3, 2),
          line("σ_xy", 6, 1e-3, 3),
        ]),
      ],
    };
  });
  return [...ofPoints, ...ofElements];
}

/** Of which steps there are rows; peaks of the others are not in the plots. */
function whichSteps(run: Run): string {
  const every = run.header.steps_between_rows;
  return every > 1 ? `one step in ${every}` : "every step";
}

/** Iterations, depths and energies by step: by step and not by time, as static steps have none. */
export function solverPlots(run: Run, clock: Clock): Plot[] {
  const step = run.arrays.get("step.step", "f64");
  const rows = step.length;
  if (rows === 0) return [];
  const values = run.arrays.get("step.values", "f32");
  const column = (name: string): Float32Array => {
    const c = run.header.step_columns.indexOf(name);
    return values.subarray(c * rows, (c + 1) * rows);
  };
  const scaled = (name: string, factor: number) => column(name).map((v) => v * factor);
  const positive = (name: string, factor: number) =>
    Array.from(column(name), (v) => (v > 0 ? factor * v : null));
  const axis = { ...overSteps(run, clock), x: step };
  const plot = (title: string, unit: string, series: Series[], more: Partial<PlotOptions> = {}) =>
    new Plot({ ...axis, title, unit, series, ...more }, clock);
  const energies: [string, string][] = [
    ["kinetic", "#0072B2"],
    ["strain", "#009E73"],
    ["gravity", "#7A5C00"],
    ["contact", "#CC79A7"],
    ["friction", "#D55E00"],
    ["damping", "#E69F00"],
    ["radiated", "#8B5FBF"],
    ["numerical", "#56B4E9"],
    ["input", "#B8A900"],
    ["water", "#1B6CA8"],
  ];
  const largest = Math.max(
    ...energies.map(([name]) => column(name).reduce((m, v) => Math.max(m, Math.abs(v)), 0)),
  );
  return [
    plot("Open-close iterations", `of ${whichSteps(run)}`, [
      { name: "iterations", values: column("iterations"), color: "--curve-1", style: "steps", width: 1 },
    ]),
    plot(
      "Penetration and movement",
      "mm, logarithmic",
      [
        { name: "penetration", values: positive("penetration", 1e3), color: "--curve-2", width: 1 },
        { name: "displacement", values: positive("max_displacement", 1e3), color: "--curve-1", width: 1 },
      ],
      { logarithmic: true },
    ),
    plot("Closed contacts", "number", [
      { name: "closed", values: column("closed_contacts"), color: "--curve-1", width: 1 },
    ]),
    plot(
      "Energy",
      "kJ per metre",
      energies.map(([name, color]) => ({ name, color, values: scaled(name, 1e-3) })),
      { height: 260, wide: true },
    ),
    plot(
      "Energy residual",
      "% of the largest term",
      [{ name: "residual", values: scaled("residual", 100 / (largest || 1)), color: "--curve-1", width: 1 }],
      { height: 260 },
    ),
  ];
}
