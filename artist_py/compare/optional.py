"""Libraries that only reports need: the extra `report`."""

import importlib

from artist_py.errors import OptionError


def load_optional(module, purpose):
    """The module, imported now; OptionError that says how to install it where it is absent."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        top = module.partition(".")[0]
        raise OptionError(
            f"{purpose}: {top} is not installed ({error}): pip install 'artist-py[report]'"
        ) from None
