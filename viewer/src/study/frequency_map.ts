import { sample, viridis } from "../colors";
import { css, h } from "../dom";
import { percent as percentText } from "./quantities";
import { integer } from "../format";
import { legendElement } from "../legend";
import type { Study } from "./data";
import type { Selection } from "./selection";

type What = "fallen" | "fallen_or_loosened";

/** How often the rock of a place falls, or falls or loosens, around the opening. */
export class FrequencyMap {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { role: "img" });
  private readonly reading = h("p", { class: "hint", role: "status" });

  constructor(
    private readonly study: Study,
    private readonly selection: Selection,
    private readonly what: What,
    title: string,
    private readonly widest = 560,
  ) {
    const box = h("div", {}, this.canvas);
    this.canvas.setAttribute("aria-label", `${title}: how often, around the opening`);
    this.element = h("figure", { class: "map" }, h("figcaption", {}, title), box, this.reading);
    new ResizeObserver(() => this.draw()).observe(box);
    selection.onChange(() => this.draw());
    this.canvas.addEventListener("pointermove", (event) => this.read(event));
    this.canvas.addEventListener("pointerleave", () => this.say(null));
    this.say(null);
  }

  private counts(): { n: number; counts: number[] } {
    const map = this.study.json.combinations[this.selection.combination]?.map;
    return { n: map?.n ?? 0, counts: map?.[this.what] ?? [] };
  }

  draw(): void {
    const { columns, rows, corner, cell_m } = this.study.json.grid;
    const width = Math.min(this.widest, this.canvas.parentElement!.clientWidth);
    if (width <= 0 || cell_m === null) return;
    const size = width / columns;
    const height = size * rows;
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    const context = this.canvas.getContext("2d")!;
    context.scale(ratio, ratio);
    context.clearRect(0, 0, width, height);
    const { n, counts } = this.counts();
    for (let j = 0; j < rows; j++)
      for (let i = 0; i < columns; i++) {
        const count = counts[j * columns + i] ?? 0;
        if (count <= 0 || n === 0) continue;
        context.fillStyle = colorOf(count / n);
        // Edges at whole pixels, so that no seams show between cells.
        const at = (k: number) => Math.round(k * size * ratio) / ratio;
        const row = rows - 1 - j;
        context.fillRect(at(i), at(row), at(i + 1) - at(i), at(row + 1) - at(row));
      }
    context.strokeStyle = css("--outline");
    context.lineWidth = 1.5;
    context.setLineDash([6, 4]);
    for (const outline of this.study.json.outlines) {
      context.beginPath();
      for (const [x, y] of outline)
        context.lineTo(((x - corner[0]) / cell_m) * size, height - ((y - corner[1]) / cell_m) * size);
      context.closePath();
      context.stroke();
    }
    context.setLineDash([]);
    context.strokeStyle = css("--line");
    context.strokeRect(0.5, 0.5, width - 1, height - 1);
  }

  private read(event: PointerEvent): void {
    const { columns, rows, cell_m } = this.study.json.grid;
    const box = this.canvas.getBoundingClientRect();
    const i = Math.floor(((event.clientX - box.left) / box.width) * columns);
    const j = rows - 1 - Math.floor(((event.clientY - box.top) / box.height) * rows);
    if (i < 0 || j < 0 || i >= columns || j >= rows || cell_m === null) return this.say(null);
    this.say([i, j]);
  }

  private say(cell: [number, number] | null): void {
    if (!cell) {
      this.reading.textContent = "";
      return;
    }
    const { columns, corner, cell_m } = this.study.json.grid;
    const { n, counts } = this.counts();
    const [i, j] = cell;
    const place = `x ${(corner[0] + (i + 0.5) * cell_m!).toFixed(2)}, y ${(corner[1] + (j + 0.5) * cell_m!).toFixed(2)} m`;
    const found = counts[j * columns + i] ?? 0;
    this.reading.textContent =
      found < 0
        ? `${place}: excavated`
        : `${place}: ${integer(found)} of ${integer(n)} realizations (${percentText(n > 0 ? found / n : null)})`;
  }
}

/** Both maps with their colours. */
export class FrequencyMaps {
  readonly element: HTMLElement;
  private readonly maps: FrequencyMap[];

  constructor(study: Study, selection: Selection) {
    const since = study.json.since ? " since the first excavation" : "";
    this.maps = [
      new FrequencyMap(study, selection, "fallen", `Fallen${since}`),
      new FrequencyMap(study, selection, "fallen_or_loosened", `Fallen or loosened${since}`),
    ];
    const bar = frequencyLegend(
      "Share of the realizations in which the rock that lay there is gone or has moved",
    );
    this.element = h("div", {}, h("div", { class: "maps" }, ...this.maps.map((m) => m.element)), bar);
  }

  draw(): void {
    for (const map of this.maps) map.draw();
  }
}

export function frequencyLegend(title: string): HTMLElement {
  return legendElement({
    title,
    bar: {
      colors: Array.from({ length: 12 }, (_, i) => colorOf(i / 11)),
      scale: { min: 0, max: 1, logarithmic: false },
      format: (v) => percentText(v),
    },
    note: "Without colour: in none. Dashed: the opening.",
  });
}

function colorOf(t: number): string {
  return sample(viridis, 0.12 + 0.88 * t);
}
