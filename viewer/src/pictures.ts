import { choice, h } from "./dom";
import { blockFields, jointFields, type BlockField, type Fields, type JointField } from "./fields";
import { count, fixed } from "./format";
import { damageStart, sinceChoices, stageTime } from "./labels";
import { legendElement } from "./legend";
import type { Moment, Run } from "./run";
import { saveButtons } from "./save/figure";
import { sectionFigure } from "./save/section_figure";
import { SectionView, type Look } from "./section_view";

interface Picture {
  title: string;
  text: string;
  moment: Moment;
}

/** The block system before the first stage and after each: one small picture per state, all with the same colours. */
export class Pictures {
  readonly element: HTMLElement;
  private readonly views: SectionView[] = [];
  private readonly look: Look;
  private readonly legends = h("div", { class: "legends" });
  private readonly grid = h("div", { class: "pictures" });
  private readonly dialog: HTMLDialogElement;
  private readonly largeLegends = h("div", { class: "legends" });
  private large: SectionView | null = null;

  constructor(
    private readonly run: Run,
    private readonly fields: Fields,
  ) {
    this.look = {
      moment: -1,
      since: damageStart(run),
      exaggeration: 1,
      blocks: "displacement",
      joints: "plain",
      marks: "none",
    };
    this.dialog = h("dialog", {
      class: "large-picture",
      "aria-label": "Enlarged picture",
      close: () => this.closed(),
    });
    const pictures = this.pictures();
    for (const picture of pictures) this.grid.append(this.figure(picture));
    // Rows of like length: 5 or 6 pictures stand in two rows of three.
    const columns = [5, 6, 9].includes(pictures.length) ? 3 : Math.min(4, pictures.length);
    this.grid.style.setProperty("--columns", String(columns));
    this.element = h("div", { class: "picture-box" }, this.controls(), this.legends, this.grid, this.dialog);
    this.updateLegends();
    new ResizeObserver(() => this.redraw()).observe(this.grid);
    addEventListener("resize", () => this.drawLarge());
  }

  private pictures(): Picture[] {
    const { run } = this;
    const pictures: Picture[] = [{ title: "Before", text: "reference position", moment: -1 }];
    for (let k = 0; k < run.stageCount(); k++) {
      const moment = run.lastFrame(k);
      if (moment < 0) continue;
      const stage = run.stages[k];
      const facts: string[] = [];
      if (stage?.excavate.length)
        facts.push(`${stage.excavate.map((e) => run.header.model.excavations[e]).join(", ")} excavated`);
      if (stage?.install?.length) facts.push(`${stage.install.join(", ")} installed`);
      if (stage?.kind === "shake" && stage.pga_m_s2 !== null)
        facts.push(`peak ${fixed(stage.pga_m_s2 / 9.81, 2)} g`);
      if (stage && stage.kind !== "settle") facts.push(stageTime(stage));
      if (stage?.kind === "settle") facts.push(count(stage.steps, "static step"));
      if (!stage || stage.interrupted) facts.push("interrupted");
      const when = stage && !stage.interrupted ? "After" : "Within";
      pictures.push({ title: `${when} “${run.stageName(k)}”`, text: facts.join(" · "), moment });
    }
    return pictures;
  }

  private controls(): HTMLElement {
    const change = (action: () => void) => {
      action();
      this.updateLegends();
      this.redraw();
    };
    const { look } = this;
    return h(
      "div",
      { class: "controls screen-only", role: "group", "aria-label": "What the pictures show" },
      choice("Blocks by", blockFields, look.blocks, (v) => change(() => (look.blocks = v as BlockField))),
      choice("Joints by", jointFields(this.run), look.joints, (v) =>
        change(() => (look.joints = v as JointField)),
      ),
      choice("Over them", this.fields.marks.choices(), look.marks, (v) => change(() => (look.marks = v))),
      choice("Displacement since", sinceChoices(this.run), String(look.since), (v) =>
        change(() => (look.since = Number(v))),
      ),
    );
  }

  private figure(picture: Picture): HTMLElement {
    const view = new SectionView(
      this.run,
      this.fields,
      { ...this.look, moment: picture.moment },
      {
        axes: false,
        label: `Block system: ${picture.title}`,
        maxHeight: 520,
      },
    );
    this.views.push(view);
    const button = h(
      "button",
      { type: "button", class: "picture", title: "Enlarge", click: () => this.enlarge(picture) },
      view.canvas,
    );
    return h(
      "figure",
      {},
      button,
      h(
        "figcaption",
        {},
        h("strong", {}, picture.title),
        h("span", {}, picture.text),
        saveButtons(() => sectionFigure(this.ownView(picture))),
      ),
    );
  }

  /** Of one picture, as large as there is room. */
  private ownView(picture: Picture): SectionView {
    const look = { ...this.look, moment: picture.moment };
    return new SectionView(this.run, this.fields, look, {
      axes: true,
      label: `Block system: ${picture.title}`,
    });
  }

  private enlarge(picture: Picture): void {
    const view = this.ownView(picture);
    this.large = view;
    const close = h("button", { type: "button", class: "close", click: () => this.dialog.close() }, "Close");
    this.dialog.replaceChildren(
      h("div", { class: "dialog-head" }, h("strong", {}, picture.title), h("span", {}, picture.text), close),
      view.canvas,
      this.largeLegends,
    );
    this.dialog.showModal();
    this.drawLarge();
  }

  private drawLarge(): void {
    if (!this.large) return;
    this.largeLegends.replaceChildren(...this.legendElements());
    this.large.options.maxHeight = Math.max(200, window.innerHeight - 190);
    this.large.resize(this.dialog.clientWidth - 32);
    this.large.draw();
  }

  private closed(): void {
    this.large = null;
    this.dialog.replaceChildren();
  }

  private legendElements(): HTMLElement[] {
    return this.fields.legends(this.look).map(legendElement);
  }

  private updateLegends(): void {
    this.legends.replaceChildren(...this.legendElements());
  }

  readTheme(): void {
    for (const view of this.views) view.readTheme();
    this.large?.readTheme();
  }

  redraw(): void {
    this.updateLegends();
    for (const view of this.views) {
      const width = view.canvas.parentElement!.clientWidth;
      if (width === 0) continue;
      view.look = { ...this.look, moment: view.look.moment };
      view.resize(width);
      view.draw();
    }
    this.drawLarge();
  }
}
