"""Methods that merge still compute the golden images."""

import pytest
from checking import assert_golden, parameters_of


@pytest.mark.parametrize("case", parameters_of("ppm", "bpm", "vcm"))
def test_image_is_the_golden_one(case):
    assert_golden(case)
