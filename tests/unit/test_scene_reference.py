"""docs/scene-reference.md says all that a scene file may say, and nothing else.

Each table of keys stands below a comment such as <!-- keys: Film, Sphere + Shape -->, which names node classes of the
scene graph: `+` leaves out the keys that a base class, documented elsewhere, gives. Every TOML block is a scene, or
the part of one, that can be read.
"""

import dataclasses
import re
import textwrap
from pathlib import Path

import pytest
import tomli

from artist_py.scene import fields, shape_types, spectrum_fields
from artist_py.scene.compile import validate
from artist_py.scene.graph import Scene
from artist_py.scene.messages import show
from artist_py.scene.reader import read_scene_text
from artist_py.scene.spectrum_types import Constant

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs" / "scene-reference.md").read_text(encoding="utf-8")
SECTION = re.compile(r"<!-- keys: (?P<classes>[^>]+) -->\n\n?(?P<table>(?:\|.*\n)+)")
BLOCK = re.compile(r"^```toml\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COLUMNS = ["key", "value", "unit", "default", "meaning"]

# What an example may refer to without saying it.
CAMERA = '[camera]\ntype = "pinhole"\nposition = [0, -4, 1]\nlook_at = [0, 0, 0]'
MATERIALS = {
    "white": 'type = "diffuse"',
    "gold": 'type = "conductor"\nmetal = "Au"',
    "glass": 'type = "dielectric"',
}


# --- what the program understands ---------------------------------------------------------------------------------


def node_classes():
    """Every node class that a scene file can make, found by following the converters from `Scene`."""
    found, waiting = [], [Scene]
    while waiting:
        cls = waiting.pop()
        if cls not in found and cls is not Constant:
            found.append(cls)
            for field in fields.keys_of(cls).values():
                waiting += classes_of(field.metadata["convert"])
    return found


def classes_of(convert):
    """The node classes that a converter may return."""
    if isinstance(convert, spectrum_fields.SpectrumField):
        return list(convert.forms.classes.values())
    if isinstance(convert, spectrum_fields.IndexField):
        return list(spectrum_fields._index_table.classes.values())
    if isinstance(convert, shape_types.EmissionField):
        return [shape_types.Emission]
    if isinstance(convert, fields.Table):
        return [convert.cls]
    if isinstance(convert, fields.Variant | fields.Forms):
        return list(convert.classes.values())
    return classes_of(convert.element) if hasattr(convert, "element") else []


def value_words(convert):
    """What the column "value" says."""
    if isinstance(convert, fields.Number):
        limits = ((">=", "at_least"), (">", "above"), ("<=", "at_most"), ("<", "below"))
        bounds = [
            f"{sign} {show(getattr(convert, name)).removesuffix('.0')}"
            for sign, name in limits
            if getattr(convert, name) is not None
        ]
        return " ".join([convert.expected, ", ".join(bounds)]).strip()
    if isinstance(convert, spectrum_fields.SpectrumField):
        bounds = value_words(convert.bounds).removeprefix("a number").strip()
        kind = "a spectrum or texture" if "image" in convert.forms.classes else "a spectrum"
        return f"{kind} {bounds}".strip()
    if isinstance(convert, spectrum_fields.IndexField):
        return "a refractive index"
    return convert.expected


def default_words(field):
    """What the column "default" says; None where it has to say it in words."""
    if field.default is dataclasses.MISSING:
        return "required"
    if isinstance(field.default, Constant):
        return show(field.default.value).removesuffix(".0")
    if field.default is None or isinstance(field.default, fields.Node):
        return None
    return show(field.default).removesuffix(".0")


# --- what the page says -------------------------------------------------------------------------------------------


def documented():
    """{(class name, key): {column: text}} of all tables."""
    rows = {}
    for match in SECTION.finditer(TEXT):
        header, _, *lines = [
            [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            for line in match["table"].splitlines()
        ]
        assert header == COLUMNS
        for name in match["classes"].split(","):
            own = name.partition("+")[0].strip()
            for cells in lines:
                row = dict(zip(COLUMNS, (cell.replace("\\|", "|") for cell in cells), strict=True))
                place = (own, row["key"].strip("`"))
                assert place not in rows, f"{place} is there twice"
                rows[place] = row
    return rows


def inherited():
    """{class name: base class name} of the tables that leave out keys of a base."""
    pairs = [name.split("+") for match in SECTION.finditer(TEXT) for name in match["classes"].split(",")]
    return {pair[0].strip(): pair[1].strip() for pair in pairs if len(pair) == 2}


def expected_fields():
    """{(class name, key): dataclass field} of all that should be documented."""
    bases, result = inherited(), {}
    for cls in [*node_classes(), *base_classes()]:
        known = fields.keys_of(cls)
        left_out = keys_of_base(cls, bases.get(cls.__name__))
        result |= {(cls.__name__, key): field for key, field in known.items() if key not in left_out}
    return result


def base_classes():
    """The bases that tables name, where they are not in a scene themselves."""
    names = set(inherited().values())
    return {base for cls in node_classes() for base in cls.__mro__ if base.__name__ in names} - set(
        node_classes()
    )


def keys_of_base(cls, name):
    base = next((base for base in cls.__mro__[1:] if base.__name__ == name), None)
    return fields.keys_of(base) if base else {}


def test_every_key_is_documented_and_no_other():
    assert sorted(documented()) == sorted(expected_fields())


def test_values_are_those_that_the_reader_expects():
    rows = documented()
    wrong = {
        place: (rows[place]["value"], value_words(field.metadata["convert"]))
        for place, field in expected_fields().items()
        if rows[place]["value"].replace("`", "") != value_words(field.metadata["convert"])
    }
    assert not wrong


def test_defaults_are_those_of_the_classes():
    rows, wrong = documented(), {}
    for place, field in expected_fields().items():
        text, words = rows[place]["default"].replace("`", ""), default_words(field)
        if (text != words) if words is not None else (not text or text == "required"):
            wrong[place] = (text, words)
    assert not wrong


def test_every_key_says_what_it_means():
    assert not [
        place for place, row in documented().items() if not re.fullmatch(r"[A-Z`].*\.", row["meaning"])
    ]


# --- examples -----------------------------------------------------------------------------------------------------


def examples():
    """The TOML blocks, each completed to a whole scene."""
    for block in BLOCK.findall(TEXT):
        table = tomli.loads(block)
        lines = [block]
        if "camera" not in table:
            lines.append(CAMERA)
        for name, text in MATERIALS.items():
            if f'material = "{name}"' in block and name not in table.get("materials", {}):
                lines.append(f"[materials.{name}]\n{text}")
        yield "\n".join(lines)


def read(text):
    """The scene of an example; its paths start in scenes/."""
    return read_scene_text(text, str(ROOT / "scenes" / "example.toml"))


@pytest.mark.parametrize("text", list(examples()), ids=lambda text: textwrap.shorten(text, 40))
def test_examples_are_valid_scenes(text):
    validate(read(text))


def test_every_key_has_an_example():
    given = set()
    for text in examples():
        collect_keys(read(text), given)
    classes = {cls.__name__: cls for cls in [*node_classes(), *base_classes()]}
    missing = [
        (name, key)
        for name, key in expected_fields()
        if not any((other, key) in given for other, cls in classes.items() if issubclass(cls, classes[name]))
    ]
    assert not missing


def collect_keys(value, given):
    """Add (class name, key) for all keys that are written in the text of a node and of all nodes in it."""
    if isinstance(value, dict):
        value = tuple(value.values())
    if isinstance(value, tuple):
        for item in value:
            collect_keys(item, given)
    elif isinstance(value, fields.Node) and value.where is not None:
        table = value.where.source.table
        for step in value.where.keys:
            table = table[step]
        known = fields.keys_of(type(value))
        given |= {(type(value).__name__, key) for key in known if isinstance(table, dict) and key in table}
        for field in known.values():
            collect_keys(getattr(value, field.name), given)
