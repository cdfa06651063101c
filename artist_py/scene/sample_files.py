"""Reads measured spectra from text files (CSV, SPD, TXT); every complaint names the file and the line."""

import math
from itertools import pairwise

from artist_py.errors import Problem, SceneError
from artist_py.scene.messages import expected

SHOWN_PROBLEMS = 5  # a wrong file has thousands; the first few say what it is
LONGEST_IN_MICROMETRES = 50  # no table in nm ends below this


def read_samples(path, column=1):
    """Wavelengths in nm and the values of one column; two tuples of floats of equal length.

    Columns are separated by semicolons or tabs (decimal commas are then understood), commas, or spaces. Lines
    starting with ; and text after # are comments; one header line may come first. Column 1 is the first after
    the wavelengths, which must increase. Raises SceneError.
    """
    problems, samples = [], []  # samples: (line, wavelength, value)
    is_first = True
    for line, text in enumerate(text_lines(path), start=1):
        fields = fields_of(text)
        if not fields:
            continue
        try:
            samples.append((line, *_sample(fields, column)))
        except ValueError as error:
            if not (is_first and number_of(fields[0]) is None):
                problems.append(Problem(str(error), str(path), line))
        is_first = False
    problems += [Problem(message, str(path), line) for line, message in _order_problems(samples)]
    if not samples and not problems:
        problems.append(Problem("expected lines with a wavelength in nm and a value, found none", str(path)))
    if problems:
        raise SceneError(_shortened(problems, path))
    return tuple(sample[1] for sample in samples), tuple(sample[2] for sample in samples)


def text_lines(path):
    """The lines of a text file; raises SceneError."""
    try:
        with open(path, "rb") as file:
            content = file.read()
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise SceneError([Problem(f"cannot be read: {reason}", str(path))]) from None
    if b"\0" in content:
        raise SceneError([Problem("expected columns of numbers in UTF-8, found no text", str(path))])
    try:
        return content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        # Instruments write names and degree signs in some code page; numbers are the same in all of them.
        return content.decode("latin-1").splitlines()


def fields_of(text):
    """The columns of one line; none if it is a comment."""
    text = text.partition("#")[0].strip()
    if not text or text.startswith(";"):
        return []
    separator = next((s for s in ";\t," if s in text), None)
    fields = [field.strip() for field in text.split(separator)]
    if separator in (";", "\t"):
        fields = [field.replace(",", ".") for field in fields]
    while fields and not fields[-1]:
        fields.pop()
    return fields


def _sample(fields, column):
    """(wavelength, value); raises ValueError with the message for the user."""
    if len(fields) <= column:
        raise ValueError(f"expected {column + 1} columns or more, found {len(fields)}")
    wavelength, value = number_of(fields[0]), number_of(fields[column])
    if wavelength is None or not 0 < wavelength < math.inf:
        raise ValueError(expected("a wavelength in nm", fields[0]))
    if value is None or not math.isfinite(value):
        raise ValueError(expected("a finite number", fields[column]))
    return wavelength, value


def number_of(field):
    """The number that a column holds, or `None`."""
    try:
        return float(field)
    except ValueError:
        return None


def _order_problems(samples):
    """(line, message) of wavelengths that do not increase or are not in nm."""
    if len(samples) > 1 and max(nm for _, nm, _ in samples) < LONGEST_IN_MICROMETRES:
        line, nm, _ = samples[0]
        return [(line, expected("wavelengths in nm", nm) + ", which looks like micrometres")]
    return [
        (line, expected(f"a wavelength above {before:.12g}, since they increase", nm))
        for (_, before, _), (line, nm, _) in pairwise(samples)
        if nm <= before
    ]


def _shortened(problems, path):
    problems = sorted(problems, key=lambda problem: problem.line or 0)
    left_out = len(problems) - SHOWN_PROBLEMS
    if left_out <= 0:
        return problems
    return [*problems[:SHOWN_PROBLEMS], Problem(f"and {left_out} more like these", str(path))]
