"""Choosing one of many with given probabilities in constant time (Walker 1977, Vose 1991)."""

import numpy as np

from ..jit import function
from ..scene.tables import alias_dtype


def build_alias_table(weights):
    """Alias table (alias_dtype) of `weights` >= 0 with a positive sum, and their probabilities, float64 (n,)."""
    weights = np.asarray(weights, float)
    probabilities = weights / weights.sum()
    table = np.zeros(len(weights), alias_dtype)
    table["probability"], table["alias"] = 1.0, np.arange(len(weights))
    scaled = probabilities * len(weights)
    small = list(np.flatnonzero(scaled < 1.0))
    large = list(np.flatnonzero(scaled >= 1.0))
    while small and large:
        less, more = small.pop(), large[-1]
        table[less] = scaled[less], more
        scaled[more] -= 1.0 - scaled[less]
        if scaled[more] < 1.0:
            small.append(large.pop())
    return table, probabilities


@function
def sample_alias(table, u):
    """Index drawn with its probability from one number u in [0, 1)."""
    scaled = u * table.shape[0]
    index = min(int(scaled), table.shape[0] - 1)
    entry = table[index]
    return index if scaled - index < entry.probability else entry.alias
