import { css } from "../dom";
import { blockDisplacement } from "../fields";
import { length, niceBelow } from "../format";
import { momentLabel } from "../labels";
import { statusNames } from "../run";
import type { SectionView } from "../section_view";
import { csvText, fileWord, head, type Figure } from "./figure";
import { drawLegends, legendsHeight } from "./legend_drawing";

const width = 1100;
const edge = 16;
const barRoom = 34;

/** What a view shows, with title, time, scale bar and legends. */
export function sectionFigure(view: SectionView): Figure {
  const { run, fields, look } = view;
  const legends = fields.legends(look);
  const inner = width - 2 * edge;
  const height = view.heightFor(inner, 760);
  const below = head + height;
  return {
    name: fileWord(
      `${run.header.model.title.slice(0, 30)} ${look.blocks} ${run.timeAt(look.moment).toFixed(3)}s`,
    ),
    title: run.header.model.title,
    subtitle: momentLabel(run, look.moment),
    width,
    height: Math.ceil(below + barRoom + legendsHeight(legends, inner) + edge),
    draw: (c, ratio) => {
      view.drawOn(c, { left: edge, top: head, width: inner, height, ratio });
      c.setTransform(ratio, 0, 0, ratio, 0, 0);
      drawScaleBar(c, view.metres(inner, height), edge + 46, below + 18);
      drawLegends(c, legends, edge, below + barRoom, inner);
    },
    csv: () => sectionCsv(view),
  };
}

/** pixels: of one metre. */
function drawScaleBar(c: CanvasRenderingContext2D, pixels: number, x: number, y: number): void {
  const metres = niceBelow(150 / pixels);
  c.strokeStyle = c.fillStyle = css("--ink");
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(x, y - 6);
  c.lineTo(x, y);
  c.lineTo(x + pixels * metres, y);
  c.lineTo(x + pixels * metres, y - 6);
  c.stroke();
  c.textAlign = "left";
  c.textBaseline = "alphabetic";
  c.font = `12px ${css("--font")}`;
  c.fillText(length(metres, 2), x + pixels * metres + 8, y + 1);
}

function sectionCsv(view: SectionView): string {
  const { run, look } = view;
  const u = run.displacementAt(look.moment);
  const since = run.displacementAt(look.since);
  const rows = Array.from({ length: run.blockCount }, (_, b) => {
    const [x, y] = blockDisplacement(run, b, u, since);
    return [
      b,
      run.blockName(b),
      run.fixed[b] ? "fixed" : statusNames[run.statusAt(look.moment, b)],
      x,
      y,
      ...run.stressAt(look.moment, b),
      run.area[b],
    ];
  });
  return csvText(["block", "name", "status", "ux_m", "uy_m", "sxx_pa", "syy_pa", "sxy_pa", "area_m2"], rows);
}
