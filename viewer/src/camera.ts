import type { Box } from "./box";

/** Where a model is drawn on a canvas; px. */
export interface Frame {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** Which part of a model is drawn in a frame, and how large. */
export class Camera {
  private centerX = 0;
  private centerY = 0;
  private zoom = 1;

  constructor(private readonly extent: Box) {
    this.fit();
  }

  /** Shows the whole model. */
  fit(): void {
    this.zoom = 1;
    this.centerX = 0.5 * (this.extent.minX + this.extent.maxX);
    this.centerY = 0.5 * (this.extent.minY + this.extent.maxY);
  }

  get isZoomed(): boolean {
    return this.zoom !== 1;
  }

  /** Pixels per metre. */
  scale(frame: Frame): number {
    const { minX, maxX, minY, maxY } = this.extent;
    return this.zoom * Math.min(frame.width / (maxX - minX), frame.height / (maxY - minY));
  }

  toPixel(frame: Frame, x: number, y: number): [number, number] {
    const scale = this.scale(frame);
    return [
      frame.left + 0.5 * frame.width + scale * (x - this.centerX),
      frame.top + 0.5 * frame.height - scale * (y - this.centerY),
    ];
  }

  toModel(frame: Frame, px: number, py: number): [number, number] {
    const scale = this.scale(frame);
    return [
      this.centerX + (px - frame.left - 0.5 * frame.width) / scale,
      this.centerY - (py - frame.top - 0.5 * frame.height) / scale,
    ];
  }

  /** Zooms by a factor so that the point under a pixel stays there. */
  zoomAt(frame: Frame, px: number, py: number, factor: number): void {
    const [x, y] = this.toModel(frame, px, py);
    this.zoomCentred(factor);
    const [x1, y1] = this.toModel(frame, px, py);
    this.centerX += x - x1;
    this.centerY += y - y1;
  }

  zoomCentred(factor: number): void {
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.5), 200);
  }

  pan(frame: Frame, dx: number, dy: number): void {
    const scale = this.scale(frame);
    this.centerX -= dx / scale;
    this.centerY += dy / scale;
  }

  /** Centres a point, enlarged at least so much. */
  show(x: number, y: number, leastZoom: number): void {
    this.centerX = x;
    this.centerY = y;
    this.zoom = Math.max(this.zoom, leastZoom);
  }
}
