"""Kernels compiled by a process of its own: the caller finds them in the cache and compiles nothing itself."""

import json
import os
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parents[1]
SCRIPT = """
import json, sys
sys.path.insert(0, {tests!r})
from rendering import render, scene, shape
from artist_py.samplers import render_job

render_job.LARGE_PIXELS = 1
sky = shape("sphere", center=[0, 1, 0], radius=2, reverse=True, emission=1)  # no material: a small kernel
compiled = scene([sky], film={{"resolution": [4, 4]}}, render={{"hero_count": 1}})
statistics = render(compiled, 1, compile_apart=True).statistics
print(json.dumps({{name: statistics[name] for name in ("cache_hits", "cache_misses")}}))
"""


def test_the_caller_only_loads(tmp_path):
    environment = {**os.environ, "ARTIST_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", SCRIPT.format(tests=str(TESTS))]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    counted = json.loads(result.stdout)
    assert counted["cache_misses"] == 0
    assert counted["cache_hits"] == 2
