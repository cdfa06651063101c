"""Tables as the text of a scene file."""


def to_toml(tables):
    """The TOML text of the tables of a scene file; nested tables become inline tables."""
    return "\n".join(f"{name} = {_value(table)}" for name, table in tables.items()) + "\n"


def _value(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {_value(item)}' for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value)
