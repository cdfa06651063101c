"""Statistics of a render as JSON, beside its image."""

import json
import math

from artist_py.film.replacing import replacing


def write_sidecar(path, statistics):
    """Write `statistics`, nested dicts and lists of text, numbers and arrays, as JSON; non-finite numbers as null."""
    text = json.dumps(_plain(statistics), indent=2, ensure_ascii=False, allow_nan=False)
    with replacing(path) as temporary:
        temporary.write_text(text + "\n", encoding="utf-8")


def _plain(value):
    if isinstance(value, dict):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):  # NumPy's arrays and numbers
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
