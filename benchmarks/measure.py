"""What all benchmarks share: renderers in child processes, the machine's description, and results on disk."""

import importlib.metadata
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
RESULTS = HERE / "results"
SCENES = HERE / "scenes"


class Renderer:
    """A child process that renders on request; a context manager."""

    def __init__(self, command, first_line=None, environment=None):
        self.process = subprocess.Popen(  # noqa: S603 - our own scripts
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={**os.environ, **(environment or {})},
        )
        if first_line is not None:
            self._send(first_line)
        self.version = self._receive()["version"]

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.process.communicate()

    def render(self, **request):
        """What the child answers to the request: a dictionary."""
        self._send(request)
        return self._receive()

    def _send(self, value):
        self.process.stdin.write(json.dumps(value) + "\n")
        self.process.stdin.flush()

    def _receive(self):
        line = self.process.stdout.readline()
        if not line:
            last_lines = self.process.stderr.read().strip().splitlines()[-3:]
            raise ChildProcessError("\n".join(last_lines) or "a renderer ended without an answer")
        return json.loads(line)


def artist_renderer(scene, overrides=None, environment=None):
    """A `Renderer` that runs this package on a scene file."""
    command = [sys.executable, "-m", "benchmarks.renderer_artist", str(scene), json.dumps(overrides or {})]
    return Renderer(command, environment=environment)


def on_one_processor(processor=None):
    """Keep this process and all its children on one processor, by default the last."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0)) if processor is None else processor})


def run_timed(command, environment=None):
    """Run a command: wall seconds and peak memory in bytes; its output is kept for the error message only."""
    begun = time.perf_counter()
    process = subprocess.Popen(  # noqa: S603 - our own commands
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env={**os.environ, **(environment or {})},
    )
    message = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise ChildProcessError(f"{' '.join(command)}: {message.strip()}")
    return time.perf_counter() - begun, usage.ru_maxrss * 1024


def machine():
    """What the figures were measured on."""
    return {
        "processor": _processor(),
        "processors": os.cpu_count(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        **{name: importlib.metadata.version(name) for name in ("numba", "numpy", "embreex")},
        "load_average": round(os.getloadavg()[0], 2),
    }


def _processor():
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    values = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in lines)}
    return f"{values.get('model name', platform.machine())} (model {values.get('model', '?')})"


def save(name, description, **figures):
    """Write a benchmark's figures, and the machine that they are from, to results/NAME.json."""
    RESULTS.mkdir(exist_ok=True)
    content = {"what": description, "date": time.strftime("%Y-%m-%d"), "machine": machine(), **figures}
    text = json.dumps(content, indent=1, default=lambda value: value.tolist())
    (RESULTS / f"{name}.json").write_text(text + "\n", encoding="utf-8")


def load(name):
    """The figures of a benchmark, or `None` if it has not been run."""
    path = RESULTS / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


def median_and_spread(values):
    """`{"median": ..., "lowest": ..., "highest": ...}`."""
    return {"median": statistics.median(values), "lowest": min(values), "highest": max(values)}
