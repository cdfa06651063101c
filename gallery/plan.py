"""Which pictures there are, what each of them depends on, and which are out of date."""

import hashlib
import json
from pathlib import Path
from typing import NamedTuple

import tomli

from artist_py.errors import ArtistError, OptionError

FORMAT = 1  # of what is kept; another one renders everything again
ROLES = {"scene": ("",), "zoom": ("",), "techniques": ("-map", "-pyramid")}


class Picture(NamedTuple):
    """An entry of the gallery, of one or several PNG files that are rendered together."""

    name: str  # files begin with it
    kind: str  # scene, equal_time, zoom or techniques
    scene: Path
    settings: dict
    text: str = ""  # below it

    @property
    def files(self):
        """`{role: name of a PNG file}`; a role is the end of the name."""
        roles = ROLES.get(self.kind)
        if roles is None:
            roles = [f"-{name}" for name in (*self.settings["integrators"], "reference")]
        return {role: f"{self.name}{role}.png" for role in roles}

    @property
    def digest(self):
        """SHA-256 in hexadecimal of what the picture shows and how it is rendered; captions do not count."""
        content = [FORMAT, self.kind, self.settings, scene_content(self.scene)]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def scene_content(file):
    """The tables of a scene file, with its includes, for JSON; comments do not count, files count by their bytes."""
    file = Path(file)
    return _content(tomli.loads(file.read_text(encoding="utf-8")), file.parent)


def _content(value, folder):
    if isinstance(value, dict):
        return {key: _content(item, folder) for key, item in value.items()}
    if isinstance(value, list):
        return [_content(item, folder) for item in value]
    if isinstance(value, str) and (folder / value).is_file():
        path = folder / value
        if path.suffix == ".toml":
            return scene_content(path)
        return [value, hashlib.sha256(path.read_bytes()).hexdigest()]
    return value


def all_pictures(file, scenes):
    """Every `Picture` that the list `file` asks for of the folder `scenes`."""
    plan, scenes = tomli.loads(Path(file).read_text(encoding="utf-8")), Path(scenes)
    lists = {
        kind: [_listed(kind, plan[kind], each, scenes) for each in plan[kind]["pictures"]]
        for kind in ("equal_time", "techniques", "zoom")
    }
    return [
        *lists["equal_time"],
        *_of_each_scene(file, plan["scene"], scenes),
        *lists["techniques"],
        *lists["zoom"],
    ]


def _of_each_scene(file, defaults, scenes):
    """A picture of every scene file, with the settings that `special` has for some of them."""
    special = defaults.pop("special", {})
    files = {path.stem: path for path in sorted(scenes.glob("*.toml"))}
    if unknown := special.keys() - files.keys():
        raise OptionError(f"{file}: scene.special: there is no scene {', '.join(sorted(unknown))}")
    return [
        Picture(name, "scene", path, {**defaults, **special.get(name, {})}, opening_comment(path))
        for name, path in files.items()
    ]


def _listed(kind, defaults, given, scenes):
    """The picture of an entry of a list, whose other keys replace those of its kind."""
    settings = {key: value for key, value in {**defaults, **given}.items() if key != "pictures"}
    scene, text = settings.pop("scene"), settings.pop("text", "")
    name = settings.pop("name", f"{scene}-{kind.replace('_', '-')}")
    # The detail is cut out by the page.
    settings.pop("detail", None)
    return Picture(name, kind, scenes / f"{scene}.toml", settings, text)


def details(file):
    """`{name of a scene: (x0, x1, y0, y1)}`, as shares: what the page shows enlarged."""
    plan = tomli.loads(Path(file).read_text(encoding="utf-8"))
    return {each["scene"]: each["detail"] for each in plan["equal_time"]["pictures"] if "detail" in each}


def together(file):
    """`[(names of scenes, text)]`: scenes whose pictures the page shows side by side, not among the others."""
    plan = tomli.loads(Path(file).read_text(encoding="utf-8"))
    return [(row["scenes"], row["text"]) for row in plan.get("together", {}).get("rows", ())]


def opening_comment(path):
    """The first paragraph of the comment that a scene file begins with."""
    words = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#") or not line.strip("# "):
            break
        words.append(line.strip("# "))
    return " ".join(words)


# --- what there is


class Manifest:
    """What has been rendered: `{name: {"digest", "files", ...}}`, kept as JSON beside the pictures."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.path = self.folder / "manifest.json"
        self.records = json.loads(self.path.read_text(encoding="utf-8")) if self.path.is_file() else {}

    def is_current(self, picture):
        """Whether the files of a picture are there, and show what it asks for."""
        record = self.records.get(picture.name)
        return (
            record is not None
            and record["digest"] == picture.digest
            and all((self.folder / file).is_file() for file in picture.files.values())
        )

    def add(self, picture, digest, facts):
        """Keep that a picture has been rendered; `facts` are for its caption."""
        self.records[picture.name] = {"digest": digest, **facts}
        self._write()

    def forget_others(self, pictures):
        """Remove records, and PNG files of them, that no picture asks for any more; returns the files' names."""
        kept = {picture.name for picture in pictures}
        names = {name for picture in pictures for name in picture.files.values()}
        gone = []
        for name in [name for name in self.records if name not in kept]:
            gone += [file for file in self.records.pop(name)["files"] if file not in names]
        for file in gone:
            (self.folder / file).unlink(missing_ok=True)
        self._write()
        return gone

    def _write(self):
        text = json.dumps(self.records, indent=1, sort_keys=True) + "\n"
        if not self.path.is_file() or self.path.read_text(encoding="utf-8") != text:
            self.path.write_text(text, encoding="utf-8")


def update(pictures, manifest, paint, say=print, force=()):
    """Render what is out of date, or named in `force`; returns `{name: error}` of what could not be.

    `paint(picture)` writes the files and returns facts for the caption. Each picture is kept as soon as it is done.
    """
    failed = {}
    due = [each for each in pictures if each.name in force or not manifest.is_current(each)]
    for number, picture in enumerate(due, 1):
        say(f"[{number}/{len(due)}] {picture.name}")
        digest = picture.digest  # before it is rendered: the scene may be edited meanwhile
        try:
            facts = paint(picture)
        except ArtistError as error:  # the others are worth having
            failed[picture.name] = str(error)
            say(f"{picture.name}: {failed[picture.name]}")
        else:
            manifest.add(picture, digest, facts)
    return failed
