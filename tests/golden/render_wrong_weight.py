"""Renders a golden case with an error of 1 % in the weight of one technique; prints the p-values of its tests.

Run as a process of its own with a kernel cache of its own (ARTIST_CACHE_DIR): the cache knows sources, not patches.
"""

import json
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]

from golden_cases import CASES, TEST_SEED, comparisons, measure, read_golden  # noqa: E402

from artist_py.jit import function  # noqa: E402
from artist_py.transport import connect  # noqa: E402

FACTOR = 1.01
right = connect.weight_of_next_event


@function
def wrong(counts, hit_ratio, emission_ratio, eye_bracket):
    """(1.15), a little too large."""
    return FACTOR * right(counts, hit_ratio, emission_ratio, eye_bracket)


if __name__ == "__main__":
    connect.weight_of_next_event = wrong
    (case,) = (case for case in CASES if case.name == sys.argv[1])
    golden = read_golden(case)
    tests = comparisons(measure(case, TEST_SEED, golden.weights), golden)
    sys.stdout.write(json.dumps({what: [test.p, bool(test.is_same)] for what, test in tests.items()}) + "\n")
