"""Tables of fluorescent scenes whose paths have wavelengths of their own (transport/shifting.py)."""

import numpy as np

from artist_py.core.table import Table
from artist_py.scene import tables
from artist_py.scene.messages import show

SHIFTING = {"pt": "independent", "ppm": "rotate"}  # `render.wavelengths` with which wavelengths shift


def shifts(render):
    """Whether paths have wavelengths of their own, by `render` of a scene where something fluoresces."""
    return SHIFTING.get(render.integrator) == render.wavelengths


def shifting_problem(render):
    """`(key, message)` of why these wavelengths have no meaning where something fluoresces, or `None`."""
    if render.wavelengths == "shared":
        return None
    if not shifts(render):
        own = SHIFTING.get(render.integrator)
        allowed = '"shared"' if own is None else f'"shared" or {show(own)}'
        message = f"expected {allowed}, since a material fluoresces, found {show(render.wavelengths)}"
        return "wavelengths", message
    if render.integrator == "ppm" and render.hero_count != 1:
        found = f"found {show(render.hero_count)}"
        message = (
            f"expected 1 with wavelengths = {show(render.wavelengths)}, since a material fluoresces, {found}"
        )
        return "hero_count", message
    return None


def with_shifting(render, scene, fluorescent, first):
    """`scene` with the tables by which wavelengths shift: for path tracing or for photon mapping."""
    matrices = fluorescent.matrices
    if render.integrator == "pt":
        return scene._replace(excitation=redistribution(matrices, first))
    emission = redistribution(matrices.transpose(0, 2, 1), first)
    nodes = Table(fluorescent.set_nodes[1])
    return scene._replace(reemission=tables.Reemission(emission, Table(matrices.astype(np.float32)), nodes))


def redistribution(matrices, first):
    """`Redistribution` from rows of `matrices` (materials, bins, bins) to their columns."""
    sums = np.cumsum(matrices, axis=2)
    totals = sums[:, :, -1]
    with np.errstate(invalid="ignore"):
        shares = np.where(totals[:, :, None] > 0.0, sums / totals[:, :, None], 1.0)
    return tables.Redistribution(
        float(first), Table(shares.astype(np.float32).ravel()), Table(totals.astype(np.float32))
    )
