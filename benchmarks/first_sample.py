"""Prints the time at which the first sample of a scene was done: `python -m benchmarks.first_sample SCENE`."""

import sys
import time

import artist_py

if __name__ == "__main__":
    scene = artist_py.load_scene(sys.argv[1], {"film.crop": [256, 257, 256, 257]})
    artist_py.render(scene, iterations=1, threads=1)
    print(time.time())
