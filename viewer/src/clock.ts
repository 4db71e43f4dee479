import type { Moment, Run } from "./run";

/** Frames of a static stage shown per second: static steps have no time of their own. */
const staticFramesPerSecond = 12;

/** The moment that the page shows. All figures that follow the animation listen to it. */
export class Clock {
  /** At first the end, which is what a reader, or paper, wants to see; playing then starts over. */
  moment: Moment;
  playing = false;
  speed = 1;
  private readonly listeners: (() => void)[] = [];
  private last = 0;

  constructor(private readonly run: Run) {
    this.moment = Math.max(0, run.frameCount - 1);
  }

  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  seek(moment: Moment): void {
    this.moment = Math.min(Math.max(moment, 0), this.run.frameCount - 1);
    this.notify();
  }

  /** To the next (+1) or previous (−1) recorded frame. */
  stepFrames(count: number): void {
    const base = count > 0 ? Math.floor(this.moment + 1e-6) : Math.ceil(this.moment - 1e-6);
    this.pause();
    this.seek(base + count);
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  play(): void {
    if (this.run.frameCount < 2) return;
    if (this.moment >= this.run.frameCount - 1) this.moment = 0;
    this.playing = true;
    this.last = performance.now();
    requestAnimationFrame((now) => this.tick(now));
    this.notify();
  }

  pause(): void {
    this.playing = false;
    this.notify();
  }

  private notify(): void {
    for (const listener of this.listeners) listener();
  }

  private tick(now: number): void {
    if (!this.playing) return;
    const elapsed = Math.min((now - this.last) / 1000, 0.2);
    this.last = now;
    this.moment = this.advanced(this.moment, elapsed * this.speed);
    if (this.moment >= this.run.frameCount - 1) this.playing = false;
    this.notify();
    if (this.playing) requestAnimationFrame((next) => this.tick(next));
  }

  /** The moment a number of seconds later: in simulated time where there is one. */
  private advanced(moment: Moment, seconds: number): Moment {
    const { time, frameCount } = this.run;
    let left = seconds;
    let at = moment;
    while (left > 0 && at < frameCount - 1) {
      const f = Math.floor(at + 1e-9);
      const interval = time[f + 1] - time[f];
      const wall = interval > 0 ? interval : 1 / staticFramesPerSecond;
      const rest = (f + 1 - at) * wall;
      if (rest > left) return at + left / wall;
      left -= rest;
      at = f + 1;
    }
    return at;
  }
}
