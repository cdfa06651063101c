"""CIEDE2000: how different two colours look beside each other; by colour-science."""

import numpy as np

from artist_py.compare.optional import load_optional
from artist_py.film.color import WHITE_XY, rgb_to_xyz


def color_difference(image, reference):
    """CIEDE2000 of each pixel, (h, w); about 1 is just noticeable. Luo, Cui and Rigg 2001.

    Images are (h, w, 3) linear sRGB in which (1, 1, 1) is white, as D65 is; colours outside sRGB's gamut count as they
    are, negative X, Y and Z as none.
    """
    load_optional("colour", "CIEDE2000")
    from colour.difference import delta_E_CIE2000
    from colour.models import XYZ_to_Lab

    lab = [XYZ_to_Lab(np.maximum(rgb_to_xyz(each), 0.0), WHITE_XY) for each in (reference, image)]
    return np.asarray(delta_E_CIE2000(*lab))
