"""Films of a run: MP4 by ffmpeg, GIF by pillow."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _optional, figures, plot
from .errors import MissingPackageError
from .frames import When

if TYPE_CHECKING:
    from .results import Result

_ENDINGS = {".mp4": "ffmpeg", ".gif": "pillow"}


def animate(run: Result, path: str | Path, color: Any = "displacement", *, start: When = 0.0, stop: When = None, every: int = 1,
            fps: float = 20.0, width: float = 160.0, dpi: float = 160.0, progress: Callable[[int, int], None] | None = None,
            **options: Any) -> Path:  # fmt: skip
    """Writes a film, a picture for each frame of the run, and returns its path.

    path: its ending says what is written, .mp4 or .gif. start, stop: moments, as in `frames.at`. every: takes each so many-th frame.
    fps: pictures per second. width: mm. dpi: pictures are width / 25.4 · dpi pixels wide.
    progress: is called with the pictures that are done, and their number. color and options: those of `keyblock.plot.plot`.
    Throws MissingPackageError without matplotlib, or without ffmpeg for MP4 and pillow for GIF.
    """
    path = Path(path)
    writer = _writer(path, fps)
    first, last = run.frames.moments.index(start), run.frames.moments.index(stop)
    if every < 1 or last < first:
        raise ValueError(f"found every = {every} and frames {first} to {last}; expected every of 1 or more, and start before stop")
    rows = list(range(first, last + 1, every))
    import matplotlib

    with matplotlib.rc_context(figures.style() | {"savefig.bbox": None}):
        # Scales are those of the whole film: the last frame is drawn first.
        picture = plot.Picture(run, run.frames[rows[-1]], plot.Options.of(color, options), film=True)
        ax = figures.new_axes(width, shown=False)
        picture.draw(ax)
        figures.fit(ax, width)
        with writer.saving(ax.figure, str(path), dpi):
            for done, row in enumerate(rows, start=1):
                picture.move_to(run.frames[row])
                writer.grab_frame()
                if progress:
                    progress(done, len(rows))
    return path


def _writer(path: Path, fps: float) -> Any:
    ending = path.suffix.lower()
    if ending not in _ENDINGS:
        raise ValueError(f"{path}: found the ending {path.suffix!r}; expected .mp4 or .gif")
    animation = _optional.need("matplotlib.animation", "a film")
    if ending == ".gif":
        _optional.need("PIL", "a film as GIF")
        return animation.PillowWriter(fps=fps)
    if shutil.which("ffmpeg") is None:
        raise MissingPackageError("a film as MP4 needs the program ffmpeg, which is not installed: apt install ffmpeg, or write a .gif")
    # Widths and heights are even, as players want them.
    filters = ["-pix_fmt", "yuv420p", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-crf", "18"]
    return animation.FFMpegWriter(fps=fps, codec="libx264", extra_args=filters)
