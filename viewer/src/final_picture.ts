import { h } from "./dom";
import type { BlockField, Fields } from "./fields";
import { quoted } from "./format";
import { damageStart } from "./labels";
import { legendElement } from "./legend";
import { saveButtons } from "./save/figure";
import { sectionFigure } from "./save/section_figure";
import { SectionView } from "./section_view";
import { Status, type Run } from "./run";

/** Pixels above and below the picture that the first screen has for other things. */
const besides = 260;
const leastHeight = 300;
const mostHeight = 620;

/** The blocks at the end of the run: by what has become of them, or by how far they moved where nothing fell or loosened. */
export class FinalPicture {
  readonly element: HTMLElement;
  private readonly view: SectionView;

  constructor(run: Run, fields: Fields) {
    const moment = run.frameCount - 1;
    const since = damageStart(run);
    const blocks: BlockField = hasDamage(run, moment) ? "status" : "displacement";
    const stage = run.stage[moment];
    const when = run.stages[stage]?.interrupted === false ? "After" : "Within";
    const title = `${when} ${quoted(run.stageName(stage))}`;
    this.view = new SectionView(
      run,
      fields,
      { moment, since, exaggeration: 1, blocks, joints: "plain", marks: "none" },
      { axes: true, label: `Block system at the end: ${title}`, maxHeight: mostHeight },
    );
    const legends = [fields.blockLegend(blocks, since), fields.elements.legend()].filter((l) => l !== null);
    this.element = h(
      "figure",
      { class: "final" },
      this.view.canvas,
      h(
        "figcaption",
        {},
        h("strong", {}, title),
        ...legends.map(legendElement),
        saveButtons(() => sectionFigure(this.view)),
      ),
    );
    new ResizeObserver(() => this.redraw()).observe(this.element);
    addEventListener("resize", () => this.redraw());
  }

  readTheme(): void {
    this.view.readTheme();
  }

  redraw(): void {
    const width = this.element.clientWidth;
    if (width === 0) return;
    this.view.options.maxHeight = Math.min(mostHeight, Math.max(leastHeight, window.innerHeight - besides));
    this.view.resize(width);
    this.view.draw();
  }
}

function hasDamage(run: Run, moment: number): boolean {
  for (let b = 0; b < run.blockCount; b++) {
    const status = run.statusAt(moment, b);
    if (status === Status.fallen || status === Status.loosened) return true;
  }
  return false;
}
