import type { Clock } from "./clock";
import { h } from "./dom";
import { count, significant } from "./format";
import { Status, type Run } from "./run";

/** What has fallen and loosened at the moment of the animation. */
export class NowFacts {
  readonly element = h("dl", { class: "facts now" });
  private frame = -1;

  constructor(
    private readonly run: Run,
    private readonly clock: Clock,
  ) {
    clock.onChange(() => this.refresh());
    this.refresh();
  }

  private refresh(): void {
    const { run } = this;
    const frame = run.frameOf(this.clock.moment);
    if (frame === this.frame) return;
    this.frame = frame;
    const blocks = [0, 0, 0, 0];
    const area = [0, 0, 0, 0];
    for (let b = 0; b < run.blockCount; b++) {
      const status = run.statusAt(frame, b);
      blocks[status]++;
      area[status] += run.area[b];
    }
    const fact = (name: string, status: Status) => {
      const value =
        blocks[status] > 0 ? `${count(blocks[status], "block")}, ${significant(area[status], 3)} m²` : "none";
      return h("div", {}, h("dt", {}, name), h("dd", {}, value));
    };
    this.element.replaceChildren(
      fact("Fallen by now", Status.fallen),
      fact("Loosened now", Status.loosened),
      fact("Excavated", Status.excavated),
    );
  }
}
