"""Runs cells one after the other in a child process, so that a crash or a hang is a result and not the end."""

import multiprocessing
import os
import signal
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

COMPILE_SECONDS = 240.0  # what compiling may add to a cell's time limit


@dataclass(frozen=True)
class Cell:
    """A case, the integrator that renders it, and how that ended: a `Measurement`, or why there is none."""

    case: object
    integrator: str
    found: object = None
    failure: tuple = ()  # (status, text)


def run_cells(cases, seed, threads, integrators=None):
    """Yield a `Cell` for each case and each of its integrators (of `integrators`, if given)."""
    with tempfile.TemporaryDirectory(prefix="artist-stress-") as folder:
        child = _Child(seed, threads)
        try:
            for index, case in enumerate(cases):
                place = Path(folder) / str(index)
                place.mkdir()
                for integrator in case.integrators:
                    if integrators is None or integrator in integrators:
                        yield child.run(case, integrator, place)
        finally:
            child.end()


class _Child:
    """The process that renders; it is started when there is something to do, and anew when it was lost."""

    def __init__(self, seed, threads):
        self.seed, self.threads, self.process = seed, threads, None

    def run(self, case, integrator, folder):
        """The `Cell`, whatever happens to the process."""
        if self.process is None:
            self._start()
        begun = time.monotonic()
        limit = begun + case.seconds + COMPILE_SECONDS
        try:
            self.pipe.send((case, integrator, folder))
            while self.pipe.poll(max(limit - time.monotonic(), 0.0)):
                kind, value = self.pipe.recv()
                if kind == "started":
                    limit = time.monotonic() + case.seconds
                    continue
                return Cell(case, integrator, **{kind: value})
        except (EOFError, OSError):
            return Cell(case, integrator, failure=("crashed", self._ending()))
        self.end()
        return Cell(case, integrator, failure=("hung", f"no result after {time.monotonic() - begun:.0f} s"))

    def _start(self):
        context = multiprocessing.get_context("spawn")  # a fork would inherit threads' locks
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=serve, args=(other, self.seed, self.threads), daemon=True)
        self.process.start()
        other.close()

    def _ending(self):
        """How a process that is no more has ended, in words."""
        self.process.join()
        code = self.process.exitcode
        self.process = None
        return f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"

    def end(self):
        """End the process, which may be busy."""
        if self.process is not None:
            self.process.kill()
            self.process.join()
            self.process = None


def serve(pipe, seed, threads):
    """What the child process does: measure what it is sent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent is interrupted, and ends this one
    os.environ["PYTHONFAULTHANDLER"] = "1"
    from artist_py.stress.measure import measure

    while True:
        try:
            case, integrator, folder = pipe.recv()
        except EOFError:
            return
        pipe.send(_answer(measure, pipe, case, integrator, seed, folder, threads))


def _answer(measure, pipe, case, integrator, seed, folder, threads):
    from artist_py.errors import ArtistError

    try:
        return "found", measure(case, integrator, seed, folder, threads, lambda: pipe.send(("started", None)))
    except ArtistError as error:
        return "failure", ("refused", str(error))
    except Exception as error:  # noqa: BLE001 - a fault of the program is what this looks for
        return "failure", ("error", f"{type(error).__name__}: {error}")
