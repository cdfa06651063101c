"""Hero wavelengths: one number places all lanes of a path (Wilkie et al. 2014), warped by a density (theory 2.5).

The density is *defined* by the nodes of its inverse distribution: lambda(u) is linear between them, and so
p(lambda) = 1 / (n (node[i+1] - node[i])) exactly.
"""

from ..jit import function
from .vector import lane_count, with_lane


@function
def sample_wavelengths(nodes, zero, u):
    """`(wavelengths, weights)`: C stratified wavelengths in nm, and 1 / (C p) of each in nm.

    `zero` fixes the number of lanes C; `nodes` has shape (n + 1,).
    """
    count = lane_count(zero)
    wavelengths, weights = zero, zero
    for i in range(count):
        wavelength, inverse_density = wavelength_at(nodes, (u + i) / count)
        wavelengths = with_lane(wavelengths, i, wavelength)
        weights = with_lane(weights, i, inverse_density / count)
    return wavelengths, weights


@function
def share_below(nodes, wavelength):
    """Probability of wavelengths below one in nm, in [0, 1]: the inverse of lambda(u)."""
    first, last = 0, nodes.shape[0] - 1
    if wavelength <= nodes[first]:
        return 0.0
    if wavelength >= nodes[last]:
        return 1.0
    while last - first > 1:
        middle = (first + last) // 2
        if nodes[middle] <= wavelength:
            first = middle
        else:
            last = middle
    return (first + (wavelength - nodes[first]) / (nodes[last] - nodes[first])) / (nodes.shape[0] - 1)


@function
def wavelength_at(nodes, u):
    """The wavelength below which the share u in [0, 1] of the density lies, nm, and 1 / p there, nm."""
    entries = nodes.shape[0] - 1
    scaled = u * entries
    index = min(int(scaled), entries - 1)
    width = nodes[index + 1] - nodes[index]
    return nodes[index] + (scaled - index) * width, width * entries
