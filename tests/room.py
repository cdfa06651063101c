"""A scene file for tests of whole comparisons: a closed room with a lamp, of features that other tests compile."""

ROOM = """
[film]
resolution = [12, 10]
filter = "box"
[camera]
type = "pinhole"
position = [0, -0.95, 0]
look_at = [0, 1, 0]
field_of_view = 80
[render]
max_path_length = 4
seed = 7
[materials.wall]
type = "diffuse"
reflectance = 0.5
[[shapes]]
type = "box"
material = "wall"
min = [-1, -1, -1]
max = [1, 1, 1]
reverse = true
[[shapes]]
type = "rectangle"
corner = [-0.3, -0.3, 0.99]
edges = [[0, 0.6, 0], [0.6, 0, 0]]
emission = 5
"""


def write_room(folder, name="room.toml", *changes):
    """The path of the scene file, with each `(old, new)` of `changes` done."""
    text = ROOM
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path = folder / name
    path.write_text(text)
    return path
