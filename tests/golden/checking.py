"""What tests of golden images share."""

import numpy as np
import pytest
from golden_cases import CASES, TEST_SEED, comparisons, measure, read_golden


def parameters_of(*integrators):
    """The cases that these render, as parameters of a test."""
    return [
        pytest.param(case, id=case.name, marks=[pytest.mark.slow] if case.is_slow else [])
        for case in CASES
        if case.integrator in integrators
    ]


def assert_golden(case):
    """A case's image has the expectation that its golden image has."""
    golden = read_golden(case)
    image = measure(case, TEST_SEED, golden.weights)
    for what, test in comparisons(image, golden).items():
        ratio = getattr(image, what).mean[test.worst] / getattr(golden, what).mean[test.worst]
        assert test.is_same, (
            f"{case.name}: {what} differ, p = {test.p:.2g}: worst at {test.worst}, by {test.z[test.worst]:.1f} "
            f"standard errors, ratio {ratio:.4f}. If that is meant, look at the image and run `make golden`"
        )
    assert np.isfinite(image.pixels.mean).all()
