import type { Clock } from "./clock";
import { choice, h } from "./dom";
import { blockDisplacement, blockFields, jointFields, principal } from "./fields";
import type { BlockField, Fields, JointField } from "./fields";
import { fixed, length, significant, stress } from "./format";
import { damageStart, momentLabel, sinceChoices } from "./labels";
import { legendElement } from "./legend";
import { Run, Status, statusNames } from "./run";
import { saveButtons } from "./save/figure";
import { filmButton } from "./save/film";
import { sectionFigure } from "./save/section_figure";
import { SectionView } from "./section_view";

const speeds = [0.25, 0.5, 1, 2, 4, 8];
const exaggerations = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];

/** Heights of the picture, px. */
const leastHeight = 260;
const largeEnough = 340;
const mostHeight = 860;

/** The animation: canvas, time slider, controls, legend and the block under the pointer. */
export class Animation {
  readonly element: HTMLElement;
  readonly view: SectionView;
  private readonly slider: HTMLInputElement;
  private readonly playButton: HTMLButtonElement;
  private readonly timeLabel: HTMLOutputElement;
  private readonly legends = h("div", { class: "legends" });
  private readonly tooltip = h("div", { class: "tooltip", role: "status", hidden: true });
  private readonly figure: HTMLElement;
  private pointer: [number, number] | null = null;
  private pending = false;
  private hoveredElement = -1;

  constructor(
    private readonly run: Run,
    private readonly fields: Fields,
    private readonly clock: Clock,
  ) {
    const since = damageStart(run);
    this.view = new SectionView(
      run,
      fields,
      {
        moment: clock.moment,
        since,
        exaggeration: 1,
        blocks: "displacement",
        joints: "plain",
        marks: "none",
      },
      {
        axes: true,
        label: "Block system at the moment of the animation",
        minHeight: leastHeight,
        maxHeight: mostHeight,
      },
    );
    this.slider = h("input", {
      type: "range",
      id: "time-slider",
      min: 0,
      max: run.frameCount - 1,
      step: 1,
      value: 0,
      "aria-label": "Frame of the animation",
      input: () => {
        const frame = Number(this.slider.value);
        clock.pause();
        clock.seek(frame);
      },
    });
    this.playButton = h("button", {
      type: "button",
      id: "play",
      class: "primary",
      click: () => clock.toggle(),
    });
    this.timeLabel = h("output", { id: "time-label", for: "time-slider" });
    this.figure = h("div", { class: "canvas-box" }, this.view.canvas, this.zoomButtons(), this.tooltip);
    this.view.canvas.tabIndex = 0;
    this.element = h(
      "div",
      { class: "animation", tabindex: "-1" },
      this.controls(),
      this.legends,
      this.figure,
      h(
        "div",
        { class: "transport" },
        this.playButton,
        h("div", { class: "track" }, this.slider, this.stageBand()),
        this.speedChoice(),
      ),
      h(
        "div",
        { class: "time-line" },
        this.timeLabel,
        saveButtons(() => sectionFigure(this.view), filmButton(this.view, clock)),
      ),
      h(
        "p",
        { class: "hint screen-only" },
        "Space plays and pauses, ← and → go one frame (with Shift ten), Home and End to the ends. Drag to move the picture; wheel with Ctrl, or after a click into the picture, to zoom; double click to fit.",
      ),
    );
    this.listen();
    this.updateLegends();
    new ResizeObserver(() => this.resize()).observe(this.figure);
    addEventListener("resize", () => this.resize());
    clock.onChange(() => this.refresh());
    this.refresh();
  }

  private controls(): HTMLElement {
    const { look } = this.view;
    const change = (action: () => void) => {
      action();
      this.updateLegends();
      this.requestDraw();
    };
    return h(
      "div",
      { class: "controls screen-only", role: "group", "aria-label": "What the animation shows" },
      choice("Blocks by", blockFields, look.blocks, (v) => change(() => (look.blocks = v as BlockField))),
      choice("Joints by", jointFields(this.run), look.joints, (v) =>
        change(() => (look.joints = v as JointField)),
      ),
      choice("Over them", this.fields.marks.choices(), look.marks, (v) => change(() => (look.marks = v))),
      choice("Displacement since", sinceChoices(this.run), String(look.since), (v) =>
        change(() => (look.since = Number(v))),
      ),
      choice(
        "Exaggeration",
        exaggerations.map((e) => ({ value: String(e), text: e === 1 ? "none" : `× ${e}` })),
        "1",
        (v) => change(() => (look.exaggeration = Number(v))),
      ),
    );
  }

  private speedChoice(): HTMLElement {
    const options = speeds.map((s) => ({ value: String(s), text: s === 1 ? "real time" : `× ${s}` }));
    const element = choice("Speed", options, "1", (v) => (this.clock.speed = Number(v)));
    element.classList.add("speed");
    return element;
  }

  private zoomButtons(): HTMLElement {
    const button = (text: string, label: string, action: () => void) =>
      h("button", { type: "button", title: label, "aria-label": label, click: action }, text);
    const zoom = (factor: number) => () => {
      this.view.zoomCentred(factor);
      this.requestDraw();
    };
    return h(
      "div",
      { class: "zoom-buttons screen-only" },
      button("+", "Zoom in", zoom(1.5)),
      button("−", "Zoom out", zoom(1 / 1.5)),
      button("⤢", "Fit the picture", () => this.fit()),
    );
  }

  private fit(): void {
    this.view.fit();
    this.requestDraw();
  }

  /** The stages under the slider, each as wide as its frames where that is wide enough for a click. */
  private stageBand(): HTMLElement {
    const { run } = this;
    const band = h("div", { class: "stage-band" });
    const whole = Math.max(1, run.frameCount - 1);
    for (let k = 0; k < run.stageCount(); k++) {
      const first = run.firstFrame(k);
      if (first < 0) continue;
      const from = k === 0 ? 0 : Math.max(0, first - 1);
      const name = run.stageName(k);
      const share = (run.lastFrame(k) - from) / whole;
      const part = h(
        "button",
        {
          type: "button",
          title: `Go to the start of “${name}”`,
          "aria-label": `Go to the start of “${name}”`,
          class: `stage-part ${run.stages[k]?.kind ?? ""}`,
          click: () => {
            this.clock.pause();
            this.clock.seek(first);
          },
        },
        share > 0.08 ? name : "",
      );
      part.style.flexGrow = String(Math.max(1e-3, share) * 1e3);
      band.append(part);
    }
    return band;
  }

  private listen(): void {
    const { canvas } = this.view;
    let drag: { x: number; y: number } | null = null;
    canvas.addEventListener("pointerdown", (event) => {
      drag = { x: event.clientX, y: event.clientY };
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (drag) {
        this.view.pan(event.clientX - drag.x, event.clientY - drag.y);
        drag = { x: event.clientX, y: event.clientY };
      }
      this.pointer = [event.offsetX, event.offsetY];
      this.requestDraw();
    });
    canvas.addEventListener("pointerup", () => (drag = null));
    canvas.addEventListener("pointercancel", () => (drag = null));
    canvas.addEventListener("pointerleave", () => {
      this.pointer = null;
      this.requestDraw();
    });
    canvas.addEventListener("dblclick", () => this.fit());
    canvas.addEventListener(
      "wheel",
      (event) => {
        // Without this the page could not be scrolled with the pointer over the picture.
        if (!event.ctrlKey && !event.metaKey && document.activeElement !== canvas) return;
        event.preventDefault();
        this.view.zoomAt(event.offsetX, event.offsetY, Math.exp(-0.0015 * event.deltaY));
        this.requestDraw();
      },
      { passive: false },
    );
    this.element.addEventListener("keydown", (event) => this.onKey(event));
  }

  private onKey(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (target instanceof HTMLSelectElement) return;
    if (event.key === " " && target instanceof HTMLButtonElement) return;
    const frames = event.shiftKey ? 10 : 1;
    const actions: Record<string, () => void> = {
      " ": () => this.clock.toggle(),
      ArrowRight: () => this.clock.stepFrames(frames),
      ArrowLeft: () => this.clock.stepFrames(-frames),
      Home: () => this.clock.seek(0),
      End: () => this.clock.seek(this.run.frameCount - 1),
    };
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  private updateLegends(): void {
    this.legends.replaceChildren(...this.fields.legends(this.view.look).map(legendElement));
  }

  private resize(): void {
    const width = this.figure.clientWidth;
    if (width > 0) {
      this.view.options.maxHeight = this.roomForPicture();
      this.view.resize(width);
      this.view.draw();
    }
  }

  /** With slider and Play the picture fits in a window; with controls and legends too, where it stays large enough. */
  private roomForPicture(): number {
    const below = 120;
    const above = this.figure.offsetTop - this.element.offsetTop + 70;
    const beside = window.innerHeight - below;
    const room = beside - above >= largeEnough ? beside - above : beside;
    return Math.min(mostHeight, Math.max(leastHeight, room));
  }

  /** For the keyboard, from the top of the page. */
  focusPlay(): void {
    this.element.scrollIntoView({ block: "start" });
    this.playButton.focus({ preventScroll: true });
  }

  private requestDraw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.hoveredElement = this.pointer ? this.view.elementAt(...this.pointer) : -1;
      this.view.hovered = this.pointer && this.hoveredElement < 0 ? this.view.blockAt(...this.pointer) : -1;
      this.view.draw();
      this.updateTooltip();
    });
  }

  private refresh(): void {
    const { clock } = this;
    this.view.look.moment = clock.moment;
    this.slider.value = String(Math.round(clock.moment));
    const label = momentLabel(this.run, clock.moment);
    this.slider.setAttribute("aria-valuetext", label);
    this.timeLabel.textContent = label;
    this.playButton.textContent = clock.playing ? "❚❚ Pause" : "▶ Play";
    this.requestDraw();
  }

  redraw(): void {
    this.updateLegends();
    this.resize();
  }

  /** Marks a block and brings it into view. */
  showBlock(block: number): void {
    this.view.selected = block;
    this.view.showBlock(block);
    this.element.scrollIntoView({ block: "start" });
    this.requestDraw();
  }

  private updateTooltip(): void {
    const block = this.view.hovered;
    const element = this.hoveredElement;
    this.tooltip.hidden = (block < 0 && element < 0) || this.pointer === null;
    if (this.tooltip.hidden || !this.pointer) return;
    const facts =
      element >= 0
        ? this.fields.elements.facts(element, this.view.look.moment)
        : blockFacts(this.run, this.view, block);
    this.tooltip.replaceChildren(...facts);
    const [x, y] = this.pointer;
    const box = this.figure.getBoundingClientRect();
    const { offsetWidth: w, offsetHeight: hh } = this.tooltip;
    this.tooltip.style.left = `${x + 16 + w < box.width ? x + 16 : Math.max(0, x - w - 12)}px`;
    this.tooltip.style.top = `${Math.min(Math.max(0, y + 14), Math.max(0, box.height - hh))}px`;
  }
}

/** Rotation of a block between two states, degrees counter-clockwise: the best fit to its vertices. */
function rotation(run: Run, block: number, u: Float32Array, since: Float32Array): number {
  const n = run.vertexCount;
  const ring = run.firstRing[block];
  const begin = run.ringBegin[ring];
  const end = run.ringEnd[ring];
  const before: [number, number][] = [];
  const after: [number, number][] = [];
  for (let v = begin; v < end; v++) {
    before.push([run.position[2 * v] + since[v], run.position[2 * v + 1] + since[n + v]]);
    after.push([run.position[2 * v] + u[v], run.position[2 * v + 1] + u[n + v]]);
  }
  const mean = (points: [number, number][], k: 0 | 1) => points.reduce((s, p) => s + p[k], 0) / points.length;
  const a = [mean(before, 0), mean(before, 1)];
  const b = [mean(after, 0), mean(after, 1)];
  let sine = 0;
  let cosine = 0;
  before.forEach(([x, y], k) => {
    const [px, py] = [x - a[0], y - a[1]];
    const [qx, qy] = [after[k][0] - b[0], after[k][1] - b[1]];
    sine += px * qy - py * qx;
    cosine += px * qx + py * qy;
  });
  return (Math.atan2(sine, cosine) * 180) / Math.PI;
}

function blockFacts(run: Run, view: SectionView, block: number): Node[] {
  const { moment } = view.look;
  const { u, since } = view.displacements();
  const [x, y] = blockDisplacement(run, block, u, since);
  const tensor = run.stressAt(moment, block);
  const p = principal(tensor);
  const rows: [string, string][] = run.fixed[block]
    ? [["fixed", "neither moves nor deforms"]]
    : [
        ["status", statusNames[run.statusAt(moment, block) as Status]],
        ["displacement", length(Math.hypot(x, y))],
        ["  to the right, up", `${length(x)}, ${length(y)}`],
        ["rotation", `${fixed(rotation(run, block, u, since), 2)}°`],
        ["σxx, σyy", `${stress(tensor[0])}, ${stress(tensor[1])}`],
        ["σxy", stress(tensor[2])],
        ["principal", `${stress(p.compressive)} at ${fixed(p.angle, 0)}°, ${stress(p.tensile)}`],
        ["area, order", `${significant(run.area[block])} m², ${run.order[block]}`],
      ];
  const list = h("dl", {});
  for (const [name, value] of rows) list.append(h("dt", {}, name), h("dd", {}, value));
  return [h("strong", {}, run.blockName(block)), list];
}
