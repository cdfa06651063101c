"""How many samples of each technique weights count with at a vertex: what is known of the place and of the material."""

from ..jit import function
from .mis import counts_of_material
from .photon_density import counts_around


@function
def counts_at(scene, method, counts, surface):
    """`Counts` for the weights at a vertex: a(x) for a of (1.7), where merges are correlated or forbidden."""
    local = counts_around(method.density, counts, surface.position)
    return counts_of_material(scene.needs.sharp, local, scene.materials[surface.material])
