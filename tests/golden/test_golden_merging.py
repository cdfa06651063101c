"""Methods that merge still compute the golden images."""

import pytest
from checking import assert_golden
from golden_cases import cases_of


@pytest.mark.parametrize("case", cases_of("ppm", "bpm", "vcm"), ids=lambda case: case.name)
def test_image_is_the_golden_one(case):
    assert_golden(case)
