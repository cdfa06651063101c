"""What a render says while it runs, on the standard error stream: a bar on a terminal, lines elsewhere."""

import sys
import time
from contextlib import suppress
from typing import NamedTuple

import click

from artist_py.errors import OutputError

LINE_SECONDS = 2.0


class Budget(NamedTuple):
    """When a render ends: at the first of those given."""

    iterations: int | None
    time_seconds: float | None
    error: float | None  # relMSE

    def fraction(self, iteration, seconds, error):
        """Share of the render that is done, in [0, 1]; relMSE falls as 1 / iterations."""
        shares = [0.0]
        if self.iterations:
            shares.append(iteration / self.iterations)
        if self.time_seconds:
            shares.append(seconds / self.time_seconds)
        if self.error and error:
            shares.append(self.error / error)
        return min(1.0, max(shares))


class Observer:
    """Hears what a sampler reports, and says nothing but warnings; `save(film)` writes an image so far."""

    def __init__(self, budget, save):
        """Take the budget and the function that writes."""
        self.budget = budget
        self._save = save

    def compiling(self, what, seconds_hint):
        """Kernels are not in the cache: hear what for, and about how long it takes, s."""

    def compiled(self, seconds):
        """Kernels are ready after `seconds`."""

    def started(self, plan):
        """Rendering starts; `plan` maps words to values, such as threads to 2."""

    def progress(self, iteration, iterations, seconds, paths, paths_per_second, error_estimate=None):
        """`iteration` iterations are done after `seconds`."""

    def snapshot(self, film):
        """Write the image so far; that this fails is no reason to lose the render."""
        try:
            self._save(film)
        except OutputError as error:
            self.warning(f"the image so far was not written: {error}")

    def warning(self, text):
        """Say what the user should know."""
        self.say(f"warning: {text}")

    def note(self, text):
        """Hear what is only worth a line when nobody asked for quiet."""

    def say(self, text):
        """Print a line; that nobody listens is no reason to lose the render either."""
        with suppress(OSError):
            click.echo(text, err=True)

    def close(self):
        """Take the bar away."""


class LineObserver(Observer):
    """Prints a line every two seconds."""

    def __init__(self, budget, save):
        """As Observer."""
        super().__init__(budget, save)
        self._next_line = 0.0

    def compiling(self, what, seconds_hint):
        """Say why nothing else happens for now."""
        self.say(f"compiling {what}: about {seconds_hint:.0f} s, once; later runs find it in the cache")

    def compiled(self, seconds):
        """Say that it is over."""
        self.say(f"compiled in {seconds:.1f} s")

    def started(self, plan):
        """Say what will be done."""
        self.say("rendering: " + ", ".join(f"{name} {value}" for name, value in plan.items()))

    def note(self, text):
        """Print it."""
        self.say(text)

    def progress(self, iteration, iterations, seconds, paths, paths_per_second, error_estimate=None):
        """Print a line, if the last was long enough ago."""
        del iterations, paths
        now = time.monotonic()
        if now < self._next_line:
            return
        self._next_line = now + LINE_SECONDS
        fraction = self.budget.fraction(iteration, seconds, error_estimate)
        self.say(
            f"iteration {iteration}{_of(self.budget)}, {fraction:.1%}, {_rate(paths_per_second)}"
            f"{_noise(error_estimate)}, {duration_text(seconds)}{_left(seconds, fraction)}"
        )


class BarObserver(LineObserver):
    """Draws a bar."""

    def __init__(self, budget, save):
        """As Observer."""
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

        super().__init__(budget, save)
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TaskProgressColumn(),
            TextColumn("{task.fields[state]}"),
        )
        self._bar = Progress(*columns, console=Console(stderr=True, highlight=False), transient=True)
        self._task = None

    def started(self, plan):
        """Say what will be done, and draw the empty bar."""
        super().started(plan)
        self._task = self._bar.add_task("iteration 0", total=1.0, state="")
        self._bar.start()

    def progress(self, iteration, iterations, seconds, paths, paths_per_second, error_estimate=None):
        """Move the bar."""
        del iterations, paths
        fraction = self.budget.fraction(iteration, seconds, error_estimate)
        state = f"{_rate(paths_per_second)}{_noise(error_estimate)}{_left(seconds, fraction)}"
        description = f"iteration {iteration}{_of(self.budget)}"
        self._bar.update(self._task, completed=fraction, description=description, state=state)

    def say(self, text):
        """Print a line above the bar."""
        self._bar.console.print(text, markup=False, soft_wrap=True)

    def close(self):
        """Take the bar away."""
        self._bar.stop()


def make_observer(budget, save, *, quiet=False):
    """Observer that suits the standard error stream."""
    if quiet:
        return Observer(budget, save)
    return BarObserver(budget, save) if sys.stderr.isatty() else LineObserver(budget, save)


def duration_text(seconds):
    """`seconds` for people: 4.2 s, 3 m 05 s, 2 h 07 m."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 60:
        return f"{minutes} m {rest:02d} s"
    return f"{minutes // 60} h {minutes % 60:02d} m"


def _of(budget):
    return f" of {budget.iterations}" if budget.iterations else ""


def _rate(paths_per_second):
    for factor, prefix in ((1e9, "G"), (1e6, "M"), (1e3, "k")):
        if paths_per_second >= factor:
            return f"{paths_per_second / factor:.2f} {prefix} paths/s"
    return f"{paths_per_second:.0f} paths/s"


def _noise(error_estimate):
    return "" if error_estimate is None else f", noise {error_estimate:.3g} relMSE"


def _left(seconds, fraction):
    return f", {duration_text(seconds * (1 - fraction) / fraction)} left" if fraction > 0 else ""
