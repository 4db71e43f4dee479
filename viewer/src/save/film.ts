import type { Clock } from "../clock";
import { h } from "../dom";
import type { SectionView } from "../section_view";
import { drawFigure, save } from "./figure";
import { sectionFigure } from "./section_figure";

const rate = 25;

/** The button that records all frames, as the view shows them, as a film. */
export function filmButton(view: SectionView, clock: Clock): HTMLButtonElement {
  const button = h("button", {
    type: "button",
    title: "Record all frames as a film (WebM)",
    "aria-label": "Record all frames as a film (WebM)",
    click: () => void record(view, clock, button),
  });
  button.textContent = "Film";
  return button;
}

async function record(view: SectionView, clock: Clock, button: HTMLButtonElement): Promise<void> {
  if (typeof MediaRecorder === "undefined" || !MediaRecorder.isTypeSupported("video/webm")) {
    button.textContent = "no WebM here";
    return;
  }
  clock.pause();
  button.disabled = true;
  const before = clock.moment;
  const first = sectionFigure(view);
  const canvas = document.createElement("canvas");
  // Even, as codecs want it.
  canvas.width = 2 * Math.round(first.width / 2);
  canvas.height = 2 * Math.round(first.height / 2);
  const c = canvas.getContext("2d", { alpha: false })!;
  const stream = canvas.captureStream(0);
  const track = stream.getVideoTracks()[0] as CanvasCaptureMediaStreamTrack;
  const recorder = new MediaRecorder(stream, { mimeType: "video/webm", videoBitsPerSecond: 4e6 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", (event) => parts.push(event.data));
  const ended = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  recorder.start();
  for (let f = 0; f < view.run.frameCount; f++) {
    clock.seek(f);
    view.look.moment = f;
    drawFigure(sectionFigure(view), c, 1);
    track.requestFrame();
    button.textContent = `${Math.round((100 * f) / view.run.frameCount)} %`;
    await new Promise((resolve) => setTimeout(resolve, 1000 / rate));
  }
  recorder.stop();
  await ended;
  save(new Blob(parts, { type: "video/webm" }), `${first.name.replace(/-[\d.]+s$/, "")}.webm`);
  clock.seek(before);
  button.disabled = false;
  button.textContent = "Film";
}
