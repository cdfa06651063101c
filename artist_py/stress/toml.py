"""Tables as the text of a scene file."""


def to_toml(tables):
    """The TOML text of the tables of a scene file; nested tables become inline tables."""
    return "\n".join(f"{name} = {toml_value(table)}" for name, table in tables.items()) + "\n"


def toml_value(value):
    """A value in one line of TOML: of text without quotes and controls, numbers, lists, tables, NumPy's of these."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{key}" = {toml_value(item)}' for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, bool):
        return str(value).lower()
    return repr(value)
