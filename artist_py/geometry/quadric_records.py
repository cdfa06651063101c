"""Quadrics as the scene compiler makes them: records with their inverse maps, and the shapes' areas in the world."""

import math

import numpy as np

from ..scene.tables import CYLINDER, DISK, SPHERE, quadric_dtype


def quadric_records(kinds, object_to_world):
    """Records (n,) of quadric_dtype from kinds (n,) and invertible affine maps (n, 3, 4).

    Raises numpy.linalg.LinAlgError for a singular map, such as that of a sphere of radius 0.
    """
    maps = np.asarray(object_to_world, np.float64)
    linear, centre = maps[:, :, :3], maps[:, :, 3:]
    inverse = np.linalg.inv(linear)
    records = np.zeros(len(maps), quadric_dtype)
    records["kind"], records["object_to_world"] = kinds, maps
    records["world_to_object"] = np.concatenate([inverse, -inverse @ centre], axis=2)
    return records


def quadric_area(quadric):
    """World area of one record, (length unit)²: closed forms, and for a skewed cone a quadrature to 1e-12.

    Ellipsoid: Carlson's R_G, NIST Digital Library of Mathematical Functions 19.33.1. Elliptic cylinder: 19.9.9.
    """
    from scipy.integrate import quad
    from scipy.special import ellipe, elliprg

    matrix = np.array(quadric.object_to_world)[:, :3]
    x, y, z = matrix.T
    if quadric.kind == SPHERE:
        a, b, c = np.linalg.svd(matrix, compute_uv=False)
        return float(4.0 * math.pi * elliprg((a * b) ** 2, (a * c) ** 2, (b * c) ** 2))
    if quadric.kind == DISK:
        return float(math.pi * np.linalg.norm(np.cross(x, y)))
    across = np.cross(x, z), np.cross(y, z)
    if quadric.kind == CYLINDER:
        # The perimeter of the ellipse cos(angle) x × z + sin(angle) y × z.
        a, b = np.linalg.svd(np.stack(across), compute_uv=False)
        return float(4.0 * a * ellipe(1.0 - (b / a) ** 2))
    base = np.cross(x, y)

    def twice_area(angle):
        # |(d/d angle) of the base circle × (apex - base circle)|
        return np.linalg.norm(math.cos(angle) * across[1] - math.sin(angle) * across[0] + base)

    return 0.5 * quad(twice_area, -math.pi, math.pi, epsrel=1e-12, epsabs=0.0, limit=500)[0]
