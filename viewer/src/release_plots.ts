import type { Clock } from "./clock";
import { Plot } from "./plots";
import type { Run } from "./run";

const curves = [
  { name: "crown", key: "crown_m", color: "--curve-1" },
  { name: "springline", key: "springline_m", color: "--curve-2" },
  { name: "mean of the wall", key: "mean_m", color: "--curve-3" },
] as const;

/** The ground reaction curve of each excavation that was opened in parts: movement of its wall over the share released. */
export function releasePlots(run: Run, clock: Clock): Plot[] {
  const all = run.stages.flatMap((s) => s.release);
  return run.header.model.excavations.flatMap((name, e) => {
    const points = all.filter((p) => p.excavation === e);
    if (points.length < 2) return [];
    const largest = Math.max(...points.flatMap((p) => curves.map(({ key }) => Math.abs(p[key] ?? 0))));
    // Where later excavations have taken the wall away, there is none.
    const drawn = curves.filter(({ key }) => points.some((p) => p[key] !== null));
    const inMetres = largest >= 1;
    const pointAt = (step: number) => points.filter((p) => p.step <= step).at(-1);
    return [
      new Plot(
        {
          title: run.header.model.excavations.length > 1 ? `Closure, ${name}` : "Closure",
          unit: inMetres ? "m" : "mm",
          xName: "released share",
          x: points.map((p) => p.released),
          xRange: [0, 1.03],
          series: drawn.map(({ name: curve, key, color }) => ({
            name: curve,
            values: points.map((p) => (p[key] === null ? null : (inMetres ? 1 : 1e3) * p[key])),
            color,
            width: 1.6,
            dots: true,
          })),
          height: 230,
          group: "release",
          now: () => pointAt(run.stepAt(clock.moment))?.released ?? NaN,
          seek: (released) => {
            const point = points.find((p) => p.released >= released) ?? points[points.length - 1];
            clock.pause();
            clock.seek(run.momentAtStep(point.step));
          },
        },
        clock,
      ),
    ];
  });
}
