"""`bpt` still computes the golden images, and those of scenes that fluoresce would show an error."""

import dataclasses

import golden_cases
import pytest
from checking import assert_golden, parameters_of
from golden_cases import CASES, TEST_SEED, comparisons, measure, read_golden

import artist_py

DYES = "cascade-bpt"
TOO_MUCH = 1.1  # which of two dyes in a row makes 1.21


@pytest.mark.parametrize("case", parameters_of("bpt"))
def test_image_is_the_golden_one(case):
    assert_golden(case)


def test_dyes_that_give_off_a_tenth_too_much_are_noticed(monkeypatch):
    """Here and not with the other test of that kind, since the kernels are those of a case above."""

    def load(*arguments):
        compiled = artist_py.load_scene(*arguments)
        dyes = compiled.fluorescence
        return dataclasses.replace(
            compiled, fluorescence=dataclasses.replace(dyes, matrices=TOO_MUCH * dyes.matrices)
        )

    monkeypatch.setattr(golden_cases, "load_scene", load)
    (case,) = (case for case in CASES if case.name == DYES)
    golden = read_golden(case)
    assert not comparisons(measure(case, TEST_SEED, golden.weights), golden)["whole"].is_same
