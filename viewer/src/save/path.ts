/** A path that knows its way as SVG, too. */
export class RecordedPath extends Path2D {
  d = "";
  override moveTo(x: number, y: number): void {
    super.moveTo(x, y);
    this.d += `M${x.toFixed(2)} ${y.toFixed(2)}`;
  }
  override lineTo(x: number, y: number): void {
    super.lineTo(x, y);
    this.d += `L${x.toFixed(2)} ${y.toFixed(2)}`;
  }
  override closePath(): void {
    super.closePath();
    this.d += "Z";
  }
}

let recording = false;

/** A path for what draws on a canvas, and at times into a file. */
export const newPath = (): Path2D => (recording ? new RecordedPath() : new Path2D());

/** Paths that are made meanwhile can be written as SVG. */
export function recordPaths(draw: () => void): void {
  recording = true;
  try {
    draw();
  } finally {
    recording = false;
  }
}
