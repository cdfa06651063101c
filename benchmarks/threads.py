"""Rate of two threads over that of one, in turns."""

import os

from .measure import SCENES, artist_renderer, median_and_spread, save

NAMES = ("cornell_box", "glass_sphere")
THREADS = 2
TARGET = 1.9


def run(options):
    """Measure and save."""
    if os.cpu_count() < THREADS:
        print(f"  left out: {THREADS} processors are needed")
        return
    scenes = {name: measure_scene(SCENES / f"{name}.toml", options) for name in NAMES}
    save("threads", __doc__, target=TARGET, threads=THREADS, scenes=scenes)


def measure_scene(path, options):
    """Wall time of one thread over that of two; on a busy machine the highest says most."""
    speed_up, work = [], []
    with artist_renderer(path) as renderer:
        renderer.render(iterations=1)
        for _ in range(options.repeats):
            one, two = (renderer.render(iterations=options.iterations, threads=n) for n in (1, THREADS))
            speed_up.append(one["seconds"] / two["seconds"])
            work.append(two["cpu_seconds"] / one["cpu_seconds"])
    result = {"speed_up": median_and_spread(speed_up), "cpu_time_of_two_over_one": median_and_spread(work)}
    print(f"  {path.stem}: {result['speed_up']['median']:.2f} times as fast", flush=True)
    return result
