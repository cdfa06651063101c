"""How far an image is from a reference: maps and means over linear values.

Images are (h, w, channels), or any other shape that both have; maps have that shape too. The offsets keep black pixels
from counting without bound, and assume images in which white is about 1.
"""

import numpy as np

RELATIVE_OFFSET = 0.001  # both as Sriwasansak, Gruson and Hachisuka 2018, section 5
SYMMETRIC_OFFSET = 0.0001


def squared_error(image, reference):
    """(I - R)^2 of each value."""
    return (_double(image) - _double(reference)) ** 2


def relative_squared_error(image, reference):
    """(I - R)^2 / (R^2 + 0.001) of each value: where the reference is bright, errors count as shares of it."""
    return squared_error(image, reference) / (_double(reference) ** 2 + RELATIVE_OFFSET)


def symmetric_error(image, reference):
    """2 |I - R| / (|I| + |R| + 0.0001) of each value, at most 2: a firefly counts no more than a hole.

    The published form has I + R, which is the same where neither is negative; linear RGB of a spectrum outside the
    gamut is.
    """
    image, reference = _double(image), _double(reference)
    return 2.0 * np.abs(image - reference) / (np.abs(image) + np.abs(reference) + SYMMETRIC_OFFSET)


def relmse(image, reference):
    """Relative mean squared error. Of two independent noisy images it expects the sum of the errors of both."""
    return float(np.mean(relative_squared_error(image, reference)))


def smape(image, reference):
    """Symmetric mean absolute percentage error, as a share: from 0 to 2."""
    return float(np.mean(symmetric_error(image, reference)))


def relmse_of_variance(variance, mean):
    """What noise of this variance adds to a relMSE in which `mean` stands in the denominators.

    With the true mean that is the error that an unbiased image expects. With the image's own, where a firefly hides its
    own error, it is what a reference adds to the error of those that are compared with it.
    """
    return float(np.mean(_double(variance) / (_double(mean) ** 2 + RELATIVE_OFFSET)))


def smape_of_variance(variance, mean):
    """The sMAPE that an unbiased image expects against the truth, for normal values: E|x| = sqrt(2 / pi) sigma."""
    mean = np.abs(_double(mean))
    deviation = np.sqrt(2.0 / np.pi * np.maximum(_double(variance), 0.0))
    return float(np.mean(2.0 * deviation / (2.0 * mean + SYMMETRIC_OFFSET)))


def _double(values):
    return np.asarray(values, np.float64)
