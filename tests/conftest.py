"""Lets tests import `rendering`, which those of several folders share."""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

# Without compilation there are no kernels to render with, and no callbacks for exact shapes.
if os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
    collect_ignore = [
        "furnace",
        "agreement",
        "compiling/test_cache.py",
        "compiling/test_left_out.py",
        "statistics/test_emitters.py",
        "unit/test_sampler.py",
    ]
