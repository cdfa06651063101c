"""Reads measured reradiation matrices from text files; every complaint names the file and the line."""

from typing import NamedTuple

import numpy as np

from artist_py.errors import Problem, SceneError
from artist_py.scene.messages import expected
from artist_py.scene.sample_files import fields_of, number_of, text_lines

SAME_WAVELENGTH = 1e-6  # nm
NOISE = 0.02  # negative values smaller than this share of the largest are noise


class MeasuredMatrix(NamedTuple):
    """A matrix as it was measured; rows are wavelengths of emission, columns of excitation."""

    emission: np.ndarray  # nm, increasing (rows,)
    excitation: np.ndarray  # nm, increasing (columns,)
    values: np.ndarray  # (rows, columns), none negative; 0 where both wavelengths are the same
    reflected: np.ndarray  # nm, increasing: where the reflectance was measured
    reflectance: np.ndarray  # at these
    warnings: list


def read_matrix(path):
    """A `MeasuredMatrix`; raises SceneError.

    The first line holds the wavelengths of excitation, nm, behind one field of any text; every other line one of
    emission and its values. Columns are separated as in files of spectra.
    """
    rows = [(line, fields) for line, text in enumerate(text_lines(path), 1) if (fields := fields_of(text))]
    if len(rows) < 3 or len(rows[0][1]) < 3:
        message = "expected a line of two or more wavelengths of excitation, and two or more of emission with values"
        raise SceneError([Problem(message, str(path))])
    header, body = rows[0], rows[1:]
    excitation = _numbers(path, header[0], header[1][1:])
    for line, fields in body:
        if len(fields) != len(header[1]):
            message = f"expected {len(header[1])} columns, as in the first line, found {len(fields)}"
            raise SceneError([Problem(message, str(path), line)])
    table = np.array([_numbers(path, line, fields) for line, fields in body])
    emission, values = table[:, 0], table[:, 1:]
    _check_order(path, [header[0]] * len(excitation), excitation)
    _check_order(path, [line for line, _ in body], emission)
    clean, warnings = without_noise(path, values.ravel(), lambda i: {"line": body[i // len(excitation)][0]})
    values = clean.reshape(values.shape)
    is_elastic = np.abs(emission[:, None] - excitation[None, :]) < SAME_WAVELENGTH
    reflected = is_elastic.any(axis=0)
    reflectance = np.where(is_elastic, values, 0.0).sum(axis=0)[reflected]
    elsewhere = np.where(is_elastic, 0.0, values)
    return MeasuredMatrix(emission, excitation, elsewhere, excitation[reflected], reflectance, warnings)


def without_noise(path, values, place):
    """`(values, warnings)` of values (n,), small negative ones as 0; SceneError of larger ones.

    `place` maps the index of a value to what a `Problem` says of where it stands.
    """
    negative = values < 0.0
    worst = int(np.argmin(values))
    if values[worst] < -NOISE * values.max():
        message = expected("values of at least 0, but for noise", values[worst])
        raise SceneError([Problem(message, str(path), **place(worst))])
    warnings = [f"{path}: {int(negative.sum())} negative values taken as 0"] if negative.any() else []
    return np.where(negative, 0.0, values), warnings


def _numbers(path, line, fields):
    found = [number_of(field) for field in fields]
    for field, number in zip(fields, found, strict=True):
        if number is None or not np.isfinite(number):
            raise SceneError([Problem(expected("a finite number", field), str(path), line)])
    return np.array(found)


def _check_order(path, lines, wavelengths):
    for line, before, nm in zip(lines[1:], wavelengths, wavelengths[1:], strict=False):
        if not 0.0 < before < nm:
            message = expected(f"a wavelength in nm above {before:.12g}, since they increase", nm)
            raise SceneError([Problem(message, str(path), line)])
