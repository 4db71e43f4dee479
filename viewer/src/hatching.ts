import { css } from "./dom";

/** The pattern of fixed blocks, in the colours of the theme. */
export function hatching(context: CanvasRenderingContext2D): CanvasPattern | null {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 8;
  const c = tile.getContext("2d")!;
  c.fillStyle = css("--fixed");
  c.fillRect(0, 0, 8, 8);
  c.strokeStyle = css("--fixed-hatch");
  c.lineWidth = 1;
  c.beginPath();
  for (const at of [-4, 4, 12]) {
    c.moveTo(at - 5, 9);
    c.lineTo(at + 5, -1);
  }
  c.stroke();
  return context.createPattern(tile, "repeat");
}
