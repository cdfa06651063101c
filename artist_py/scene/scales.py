"""How much of a spectrum gives a wanted power, luminance or illuminance."""

from artist_py.errors import SceneError
from artist_py.scene.where import problem

POWER_RANGE = 300, 780  # nm over which `power` is meant


def ratio(node, key, wanted, unit):
    """The factor that makes `unit`, which the spectrum gives by itself, the one wanted by `key`; raises SceneError."""
    if wanted == 0.0:
        return 0.0
    if not unit > 0.0:
        message = f"the spectrum has no {key}, and no factor can give it one"
        raise SceneError([problem(node, key, message)])
    return wanted / unit
