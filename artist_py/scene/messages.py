"""The words of scene errors: values as the user wrote them, choices, and the nearest known name."""

import json
import re
from difflib import get_close_matches

BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def show(value, depth=0):
    """A value in TOML's notation, never long."""
    if isinstance(value, str):
        text = json.dumps(value[:60], ensure_ascii=False)
    elif isinstance(value, bool):
        text = str(value).lower()
    elif isinstance(value, int):
        text = str(value) if value.bit_length() <= 128 else "a number of more than 128 bits"
    elif isinstance(value, dict):
        items = [f"{name} = {show(v, depth + 1)}" for name, v in list(value.items())[:8]] if depth < 3 else []
        text = "{ " + ", ".join(items) + " }" if items else "a table" if value else "{}"
    elif isinstance(value, list | tuple):
        text = "[" + ", ".join(show(v, depth + 1) for v in value[:16]) + "]" if depth < 3 else "an array"
    else:
        text = str(value).removesuffix(".0")
    return text if len(text) <= 80 else text[:77] + "..."


def dotted(keys):
    """A path of keys and indices as TOML writes it, with quotes where a key needs them."""
    return ".".join(str(key) if BARE_KEY.fullmatch(str(key)) else show(key) for key in keys)


def listing(words):
    """Words as a choice: "a", "b" or "c"; a long list is cut."""
    words = [show(word) for word in words]
    if len(words) > 20:
        words[20:] = ["..."]
        return ", ".join(words)
    return " or ".join(filter(None, [", ".join(words[:-1]), words[-1]])) if words else "nothing"


def nearest(word, known, *, otherwise=True, cutoff=0.6):
    """The end of a message about an unknown word: the known one it is near, otherwise all that are known."""
    by_lower = {str(name).lower(): name for name in known}
    match = get_close_matches(str(word)[:60].lower(), by_lower, n=1, cutoff=cutoff)
    if match:
        return f", did you mean {show(by_lower[match[0]])}?"
    return f", expected {listing(known)}" if otherwise and known else ""


def expected(what, found):
    """The message of a value that is something else than it should be."""
    return f"expected {what}, found {show(found)}"
