"""Lets tests import `rendering`, which those of several folders share."""

import gc
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

# Compiling makes many objects that stay: to look for garbage among them all so often takes a tenth of its time.
gc.set_threshold(200_000, 50, 100)

# Without compilation there are no kernels to render with, and no callbacks for exact shapes.
if os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
    collect_ignore = [
        "furnace",
        "agreement",
        "compiling/test_cache.py",
        "evidence/test_ablation.py",
        "evidence/test_convergence.py",
        "evidence/test_image_noise.py",
        "evidence/test_reference.py",
        "evidence/test_snapshots.py",
        "compiling/test_left_out.py",
        "statistics/test_emitters.py",
        "unit/cli/test_converge.py",
        "unit/test_sampler.py",
    ]
