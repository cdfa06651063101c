"""A render that stops to be looked at: the film after so many seconds, whose measuring takes no time of the render."""

import resource
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ..film.image import FilmImage
from .render_job import Silence, film_image, film_of, sampler_for

AXES = ("wall", "cpu", "iterations")


@dataclass(frozen=True)
class Snapshot:
    """The image so far, and what it took from the start of the first iteration."""

    mark: float  # the last of the marks that was reached
    film: FilmImage
    iterations: int
    wall_seconds: float
    cpu_seconds: float  # of all threads
    rays: int  # closest hits
    shadow_rays: int
    peak_memory_bytes: int  # of the process, since its kernels were ready
    render_memory_bytes: int  # what this added to the process since then: film, subpaths, photons
    noise: float | None  # relMSE, as the film estimates it of itself
    compile_seconds: float

    def along(self, axis):
        """Seconds of that clock, or iterations."""
        return {"wall": self.wall_seconds, "cpu": self.cpu_seconds, "iterations": self.iterations}[axis]


def snapshots(compiled, settings, marks, axis="wall", observer=None, stop=None):
    """Yield a `Snapshot` after the first iteration that ends at or beyond each mark; at one, if it passes several.

    Marks are seconds of wall or CPU time, or iterations. The clocks stand still while the caller works. Of `settings`,
    the limits do not apply. Ends after the last mark, or when `stop` is set.
    """
    observer = observer or Silence()
    film, marks = film_of(compiled, settings), sorted(marks)
    with sampler_for(compiled, film, settings, observer) as sampler:
        compile_seconds = sampler.compile_kernels(observer)
        reset_peak_memory()
        # Arrays that nobody has written to yet are not in memory yet.
        before = resident_memory()
        spent = {"wall": 0.0, "cpu": 0.0, "iterations": 0}
        while marks and not (stop is not None and stop.is_set()):
            if not _timed_iteration(sampler, film, spent, stop):
                return
            passed = [mark for mark in marks if mark <= spent[axis]]
            if passed:
                marks = marks[len(passed) :]
                image = film_image(compiled, settings, film, {})
                yield _snapshot(image, film, sampler, spent, passed[-1], compile_seconds, before)


def _timed_iteration(sampler, film, spent, stop):
    wall, cpu = time.perf_counter(), time.process_time()
    is_whole = sampler.iterate(film.iterations, stop)
    spent["wall"] += time.perf_counter() - wall
    spent["cpu"] += time.process_time() - cpu
    spent["iterations"] += 1
    return is_whole


def _snapshot(image, film, sampler, spent, mark, compile_seconds, memory_before):
    rays, shadow_rays = sampler.rays
    peak = peak_memory()
    return Snapshot(
        mark=mark,
        film=image,
        iterations=film.iterations,
        wall_seconds=spent["wall"],
        cpu_seconds=spent["cpu"],
        rays=rays,
        shadow_rays=shadow_rays,
        peak_memory_bytes=peak,
        render_memory_bytes=max(0, peak - memory_before),
        noise=film.error_estimate(),
        compile_seconds=compile_seconds,
    )


def reset_peak_memory():
    """Forget the process's highest memory use so far, where the system allows it (Linux, proc(5))."""
    with suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")


def peak_memory():
    """The highest resident memory of the process since `reset_peak_memory`, bytes."""
    return _status("VmHWM")


def resident_memory():
    """Resident memory of the process, bytes."""
    return _status("VmRSS")


def _status(field):
    """A size in Linux's account of the process; elsewhere the highest resident memory since its start."""
    with suppress(OSError, StopIteration):
        lines = Path("/proc/self/status").read_text().splitlines()
        return int(next(line for line in lines if line.startswith(f"{field}:")).split()[1]) * 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
