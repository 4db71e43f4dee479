import { css } from "../dom";
import { RecordedPath } from "./path";

const escaped = (text: string) =>
  text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]!);
const at = (x: number) => String(Math.round(100 * x) / 100);

interface State {
  fillStyle: string | CanvasGradient | CanvasPattern;
  strokeStyle: string | CanvasGradient | CanvasPattern;
  lineWidth: number;
  lineJoin: string;
  lineCap: string;
  globalAlpha: number;
  font: string;
  textAlign: string;
  textBaseline: string;
  dash: number[];
  shift: [number, number];
  clip: string;
}

const first: State = {
  fillStyle: "#000",
  strokeStyle: "#000",
  lineWidth: 1,
  lineJoin: "miter",
  lineCap: "butt",
  globalAlpha: 1,
  font: "12px sans-serif",
  textAlign: "left",
  textBaseline: "alphabetic",
  dash: [],
  shift: [0, 0],
  clip: "",
};

/** The part of CanvasRenderingContext2D that pictures of the page are drawn by, written as SVG. */
export class SvgContext {
  private state: State = { ...first };
  private readonly kept: State[] = [];
  private readonly body: string[] = [];
  private readonly defs: string[] = [];
  private d = "";
  private readonly measuring = document.createElement("canvas").getContext("2d")!;

  /** As a canvas, for what draws on one. */
  static on(): { context: CanvasRenderingContext2D; svg: SvgContext } {
    const svg = new SvgContext();
    const context = new Proxy(svg, {
      get: (target, name) => {
        const value = Reflect.get(name in target ? target : target.state, name);
        return typeof value === "function" ? value.bind(target) : value;
      },
      set: (target, name, value) => Reflect.set(target.state, name, value),
    });
    return { context: context as unknown as CanvasRenderingContext2D, svg };
  }

  text(width: number, height: number): string {
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">` +
      `<defs>${this.defs.join("")}</defs>\n${this.body.join("\n")}\n</svg>\n`
    );
  }

  private paint(style: State["fillStyle"]): string {
    return typeof style === "string" ? style : css("--fixed");
  }
  private add(element: string): void {
    const { shift, clip } = this.state;
    const moved = shift[0] || shift[1] ? ` transform="translate(${at(shift[0])} ${at(shift[1])})"` : "";
    this.body.push(element.replace("@", `${moved}${clip}`));
  }
  private alpha(): string {
    return this.state.globalAlpha < 1 ? ` opacity="${this.state.globalAlpha}"` : "";
  }

  setTransform(_a: number, _b: number, _c: number, _d: number, e: number, f: number): void {
    this.state.shift = [e, f];
  }
  save(): void {
    this.kept.push({ ...this.state });
  }
  restore(): void {
    this.state = this.kept.pop() ?? { ...first };
  }
  setLineDash(dash: number[]): void {
    this.state.dash = dash;
  }
  measureText(text: string): TextMetrics {
    this.measuring.font = this.state.font;
    return this.measuring.measureText(text);
  }

  beginPath(): void {
    this.d = "";
  }
  moveTo(x: number, y: number): void {
    this.d += `M${at(x)} ${at(y)}`;
  }
  lineTo(x: number, y: number): void {
    this.d += `L${at(x)} ${at(y)}`;
  }
  closePath(): void {
    this.d += "Z";
  }
  /** Whole circles only. */
  arc(x: number, y: number, r: number): void {
    this.d += `M${at(x - r)} ${at(y)}a${at(r)} ${at(r)} 0 1 0 ${at(2 * r)} 0a${at(r)} ${at(r)} 0 1 0 ${at(-2 * r)} 0Z`;
  }
  rect(x: number, y: number, w: number, h: number): void {
    this.d += `M${at(x)} ${at(y)}h${at(w)}v${at(h)}h${at(-w)}Z`;
  }
  clip(): void {
    const id = `clip${this.defs.length}`;
    this.defs.push(`<clipPath id="${id}"><path d="${this.d}"/></clipPath>`);
    this.state.clip = ` clip-path="url(#${id})"`;
  }
  fill(rule?: CanvasFillRule): void {
    const evenOdd = rule === "evenodd" ? ' fill-rule="evenodd"' : "";
    this.add(`<path@ fill="${this.paint(this.state.fillStyle)}"${evenOdd}${this.alpha()} d="${this.d}"/>`);
  }
  stroke(path?: Path2D): void {
    const { strokeStyle, lineWidth, lineJoin, lineCap, dash } = this.state;
    const d = path instanceof RecordedPath ? path.d : this.d;
    if (d === "") return;
    const dashes = dash.length > 0 ? ` stroke-dasharray="${dash.join(" ")}"` : "";
    this.add(
      `<path@ fill="none" stroke="${this.paint(strokeStyle)}" stroke-width="${at(lineWidth)}" stroke-linejoin="${lineJoin}" stroke-linecap="${lineCap}"${dashes}${this.alpha()} d="${d}"/>`,
    );
  }
  fillRect(x: number, y: number, w: number, h: number): void {
    this.add(
      `<rect@ x="${at(x)}" y="${at(y)}" width="${at(w)}" height="${at(h)}" fill="${this.paint(this.state.fillStyle)}"/>`,
    );
  }
  strokeRect(x: number, y: number, w: number, h: number): void {
    const { strokeStyle, lineWidth } = this.state;
    this.add(
      `<rect@ x="${at(x)}" y="${at(y)}" width="${at(w)}" height="${at(h)}" fill="none" stroke="${this.paint(strokeStyle)}" stroke-width="${at(lineWidth)}"/>`,
    );
  }
  fillText(text: string, x: number, y: number): void {
    const { fillStyle, font, textAlign, textBaseline } = this.state;
    const anchor = { center: "middle", right: "end", end: "end" }[textAlign] ?? "start";
    const size = Number(/([\d.]+)px/.exec(font)?.[1] ?? 12);
    const down = { top: 0.8, middle: 0.35 }[textBaseline] ?? 0;
    const weight = /\b(bold|[6-9]00)\b/.test(font) ? ' font-weight="bold"' : "";
    this.add(
      `<text@ x="${at(x)}" y="${at(y + down * size)}" text-anchor="${anchor}" font-family="Helvetica, Arial, sans-serif" font-size="${size}"${weight} fill="${this.paint(fillStyle)}">${escaped(text)}</text>`,
    );
  }
}
