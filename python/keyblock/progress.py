"""How far a run or a study is: a bar in a notebook, a line of text elsewhere, or a function of the caller's own.

    scenario.run("out/tunnel", progress=True)

A notebook shows a bar where the package ipywidgets is there, and else the line of text.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from ._optional import has

_LEAST_WAIT = 0.1  # s between two looks: a notebook gets each of them as a message
_WIDTH = 78  # characters of a line


class TextLine:
    """One line that is redrawn, on standard error; in a notebook in the output of the cell."""

    def __init__(self, in_cell: bool = False) -> None:
        self._stream = sys.stdout if in_cell else sys.stderr

    def show(self, fraction: float, text: str) -> None:
        bar = "━" * round(24 * fraction)
        print(f"\r{f'{bar:<24} {fraction:4.0%} {text}'[:_WIDTH]:<{_WIDTH}}", end="", file=self._stream, flush=True)

    def close(self, ended: bool) -> None:
        print("" if ended else " stopped", file=self._stream, flush=True)


class NotebookBar:
    """A bar of ipywidgets under the cell: green at the end, red where the run was stopped."""

    def __init__(self) -> None:
        import ipywidgets
        from IPython.display import display

        self._bar = ipywidgets.FloatProgress(value=0.0, min=0.0, max=1.0)
        self._text = ipywidgets.Label("")
        display(ipywidgets.HBox([self._bar, self._text]))

    def show(self, fraction: float, text: str) -> None:
        self._bar.value = fraction
        self._text.value = f"{fraction:.0%} {text}"

    def close(self, ended: bool) -> None:
        self._bar.bar_style = "success" if ended else "danger"


def in_notebook() -> bool:
    """Whether this process is the kernel of a notebook. Asks IPython only where somebody has imported it."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython else None
    return getattr(shell, "kernel", None) is not None


class _Throttled:
    """Passes on what is shown, ten times a second at most, and the last of all."""

    def __init__(self, display: TextLine | NotebookBar) -> None:
        self._display = display
        self._shown = -_LEAST_WAIT
        self._waiting: tuple[float, str] | None = None

    def show(self, fraction: float, text: str) -> None:
        self._waiting = (fraction, text)
        if time.monotonic() - self._shown >= _LEAST_WAIT:
            self._flush()

    def _flush(self) -> None:
        if self._waiting is not None:
            self._display.show(*self._waiting)
            self._waiting = None
            self._shown = time.monotonic()

    def close(self, ended: bool) -> None:
        self._flush()
        self._display.close(ended)


def _display_for(progress: Any) -> _Throttled:
    if progress is not True and not (isinstance(progress, str) and progress in ("notebook", "line")):
        raise ValueError(f"progress: {progress!r}; expected a function, True, 'notebook', 'line' or None")
    notebook = in_notebook()
    wants_bar = progress == "notebook" or (progress is True and notebook)
    return _Throttled(NotebookBar() if wants_bar and has("ipywidgets") and has("IPython") else TextLine(notebook))


class Progress:
    """What a run or a study calls as it goes on, and what ends the display. `progress`: None or False: nothing is shown; True: as is best
    here; "notebook": a bar of ipywidgets, or the line without it; "line": the line; or a function. `words` makes what is shown, a fraction
    and a text, of what the function would get."""

    def __init__(self, progress: Any, words: Callable[..., tuple[float, str]]) -> None:
        self._words = words
        self._display: _Throttled | None = None
        self.call: Callable[..., Any] | None = None
        if callable(progress):
            self.call = progress
        elif progress is not None and progress is not False:
            self._display = _display_for(progress)
            self.call = self._show

    def _show(self, *now: Any) -> None:
        assert self._display is not None
        self._display.show(*self._words(*now))

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, error: object, *_: object) -> None:
        if self._display is not None:
            self._display.close(ended=error is None)


def words_of_run(now: Any) -> tuple[float, str]:
    """Of a keyblock.Simulation: `now` is a Progress of the compiled module."""
    left = f", {now.seconds_left:.0f} s left" if now.seconds_left >= 0.0 else ""
    return now.fraction, f"{now.stage + 1}/{now.stages} {now.stage_name}, step {now.step}{left}"


def words_of_study(done: int, runs: int) -> tuple[float, str]:
    return done / max(runs, 1), f"{done} of {runs} runs"
