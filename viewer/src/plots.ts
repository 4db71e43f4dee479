import uPlot from "uplot";
import type { Clock } from "./clock";
import { css, h, symbols } from "./dom";
import { powerOfTen, significant } from "./format";
import { saveButtons } from "./save/figure";
import { plotFigure } from "./save/plot_figure";

export interface Series {
  name: string;
  values: ArrayLike<number | null>;
  /** A colour, or the name of a custom property that holds it. */
  color: string;
  /** Drawn as steps or points where a line between rows would say too much. */
  style?: "line" | "steps";
  width?: number;
  /** Rows are few, and each is marked. */
  dots?: boolean;
}

export interface PlotOptions {
  title: string;
  unit: string;
  xName: string;
  x: ArrayLike<number>;
  series: Series[];
  height?: number;
  logarithmic?: boolean;
  /** Takes two columns of the grid of plots. */
  wide?: boolean;
  range?: [number, number];
  /** Of the abscissa, where all of it is shown: wider than the rows, as of several at its end only the first would be drawn. */
  xRange?: [number, number];
  /** A second axis at the right: values of the left one divided by `divisor`. */
  right?: { divisor: number };
  /** Leaves the room of a right axis free, so that plots above each other are as wide. */
  rightSpace?: boolean;
  /** Plots of one group share the pointer's position. */
  group: string;
  /** The abscissa at which the animation stands, and the way back. */
  now: () => number;
  seek: (x: number) => void;
}

/** Width of a right axis, and least width of a left one, so that most plots above each other are as wide; px. */
const rightAxis = 44;
const leftAxis = 56;

const colorOf = (s: Series) => (s.color.startsWith("--") ? css(s.color) : s.color);

function decades(min: number, max: number): number[] {
  const values: number[] = [];
  for (let k = Math.ceil(Math.log10(min) - 1e-9); 10 ** k <= max * (1 + 1e-9); k++) values.push(10 ** k);
  return values;
}

/** Labels of an axis, without zeros at the end of a mantissa. */
function axisLabel(value: number | null): string {
  return value === null ? "" : significant(value, 5).replace(/\.?0+ ×/, " ×");
}

function decadeLabel(value: number | null): string {
  if (value === null || !(value > 0)) return "";
  const exponent = Math.round(Math.log10(value));
  return Math.abs(exponent) <= 1 ? significant(10 ** exponent, 2) : powerOfTen(exponent);
}

/** Width of a vertical axis with these labels, px. */
function axisWidth(plot: uPlot, labels: string[] | null, axis: number, cycle: number): number {
  const { font, ticks, gap, _size } = plot.axes[axis] as uPlot.Axis & { _size: number };
  if (cycle > 1) return _size; // uPlot asks again until sizes stay as they are
  const context = plot.ctx;
  context.save();
  context.font = (font as unknown as string[])[0];
  const widest = Math.max(0, ...(labels ?? []).map((text) => context.measureText(text ?? "").width));
  context.restore();
  const width = Math.ceil((ticks?.size ?? 0) + (gap ?? 0) + widest / devicePixelRatio) + 1;
  return Math.max(width, axis === 1 ? leftAxis : rightAxis);
}

/** A plot over time or steps with a line at the moment of the animation; a click moves the animation there. */
export class Plot {
  readonly element: HTMLElement;
  private plot: uPlot | null = null;
  private readonly target: HTMLElement;
  private readonly readings: HTMLElement[] = [];
  private readonly marker = h("div", { class: "now-line", "aria-hidden": "true" });

  constructor(
    private readonly options: PlotOptions,
    private readonly clock: Clock,
  ) {
    this.target = h("div", { class: "plot-target" });
    const caption = h(
      "figcaption",
      {},
      h("strong", {}, options.title),
      h("span", { class: "unit" }, symbols(options.unit)),
    );
    caption.append(
      this.key(),
      saveButtons(() => plotFigure(options, document.title)),
    );
    this.element = h(
      "figure",
      { class: options.wide ? "plot wide" : "plot", "aria-label": `${options.title} (${options.unit})` },
      caption,
      this.target,
    );
    new ResizeObserver(() => this.resize()).observe(this.target);
    clock.onChange(() => this.moveMarker());
  }

  private resize(): void {
    const width = this.target.clientWidth;
    if (width <= 0) return;
    if (!this.plot) this.build(width);
    else if (this.plot.width !== width) this.plot.setSize({ width, height: this.plot.height });
    this.moveMarker();
  }

  /** Builds anew, with the colours of the theme. */
  rebuild(): void {
    this.plot?.destroy();
    this.plot = null;
    this.resize();
  }

  private build(width: number): void {
    const { clock, options } = this;
    const axis = {
      stroke: css("--muted"),
      font: `11px ${css("--font")}`,
      grid: { stroke: css("--grid"), width: 1 },
      ticks: { stroke: css("--grid"), width: 1, size: 4 },
    };
    const number = (_: uPlot, values: (number | null)[]) => values.map(axisLabel);
    const axes: uPlot.Axis[] = [
      {
        ...axis,
        label: options.xName,
        labelFont: axis.font,
        labelSize: 18,
        labelGap: 0,
        size: 26,
        values: number,
      },
      {
        ...axis,
        size: axisWidth,
        values: number,
        space: 26,
        ...(options.logarithmic
          ? {
              splits: (_: uPlot, __: number, min: number, max: number) => decades(min, max),
              values: (_: uPlot, values: (number | null)[]) => values.map(decadeLabel),
            }
          : {}),
      },
    ];
    if (options.right)
      axes.push({ ...axis, scale: "right", side: 1, size: axisWidth, values: number, grid: { show: false } });
    const divisor = options.right?.divisor ?? 1;
    // Nothing but zeros would be drawn on an axis to 100.
    const isZero = options.series.every((s) => Array.from(s.values).every((v) => !v));
    const range = options.range ?? (isZero && !options.logarithmic ? [0, 1] : undefined);
    const { xRange } = options;
    const plot = new uPlot(
      {
        width,
        height: options.height ?? 190,
        padding: [8, options.right ? 0 : options.rightSpace ? rightAxis : 12, 0, 0],
        scales: {
          x: {
            time: false,
            ...(xRange
              ? {
                  range: (_: uPlot, min: number, max: number): uPlot.Range.MinMax =>
                    min <= options.x[0] && max >= options.x[options.x.length - 1] ? xRange : [min, max],
                }
              : {}),
          },
          y: {
            distr: options.logarithmic ? 3 : 1,
            ...(range ? { range: () => range } : {}),
          },
          ...(options.right
            ? {
                right: {
                  from: "y",
                  range: (_: uPlot, min: number, max: number): uPlot.Range.MinMax => [
                    min / divisor,
                    max / divisor,
                  ],
                },
              }
            : {}),
        },
        axes,
        series: [
          { label: options.xName, value: (_, v) => significant(v, 5) },
          ...options.series.map((s) => ({
            label: s.name,
            stroke: colorOf(s),
            width: s.width ?? 1.2,
            points: s.dots ? { show: true, size: 5, fill: colorOf(s) } : { show: false },
            pxAlign: 0,
            spanGaps: false,
            value: (_: uPlot, v: number | null) => significant(v, 4),
            ...(s.style === "steps" ? { paths: uPlot.paths.stepped!({ align: 1 }) } : {}),
          })),
        ],
        cursor: {
          drag: { x: true, y: false },
          sync: { key: options.group, scales: ["x", null] },
          points: { size: 6 },
        },
        legend: { show: false },
        hooks: {
          setCursor: [(u) => this.showReadings(u.cursor.idx ?? null)],
          setScale: [(_, scale) => scale === "x" && this.moveMarker()],
        },
      },
      [options.x, ...options.series.map((s) => s.values)] as uPlot.AlignedData,
      this.target,
    );
    plot.ctx.canvas.setAttribute("role", "img");
    plot.ctx.canvas.setAttribute("aria-label", `${options.title} over ${options.xName}`);
    plot.over.append(this.marker);
    let pressedAt = 0;
    let before = clock.moment;
    plot.over.addEventListener("mousedown", (event) => (pressedAt = event.clientX));
    plot.over.addEventListener("click", (event) => {
      // A drag, which zooms, ends with a click, too; a double click, which ends the zoom, begins with one.
      if (Math.abs(event.clientX - pressedAt) >= 3 || event.detail > 1) return;
      before = clock.moment;
      options.seek(plot.posToVal(event.offsetX, "x"));
    });
    plot.over.addEventListener("dblclick", () => clock.seek(before));
    this.plot = plot;
  }

  private moveMarker(): void {
    if (!this.plot) return;
    const x = this.plot.valToPos(this.options.now(), "x");
    const inside = x >= -0.5 && x <= this.plot.over.clientWidth + 0.5;
    this.marker.hidden = !inside;
    this.marker.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  /** Names of the curves, each with its value under the pointer. */
  private key(): HTMLElement {
    const key = h("span", { class: "plot-key" });
    for (const s of this.options.series) {
      const swatch = h("span", { class: "swatch line" });
      swatch.style.background = s.color.startsWith("--") ? `var(${s.color})` : s.color;
      const reading = h("span", { class: "reading" });
      this.readings.push(reading);
      key.append(
        h("span", {}, ...(this.options.series.length > 1 ? [swatch, symbols(s.name)] : []), reading),
      );
    }
    return key;
  }

  private showReadings(index: number | null): void {
    this.options.series.forEach((s, k) => {
      const value = index === null ? null : s.values[index];
      this.readings[k].textContent = value === null || value === undefined ? "" : ` ${significant(value, 4)}`;
    });
  }
}
