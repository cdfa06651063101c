"""The few figures that the project's README shows: `python -m benchmarks --summary` prints them as a table."""

from .measure import load

MIB = 2**20


def summary():
    """Markdown: one row per figure that was measured."""
    rows = [row for write in (speed, embree_share, start_up, memory, threads, triangles) for row in write()]
    return "\n".join(
        ["| what | measured |", "| --- | --- |", *(f"| {what} | {figure} |" for what, figure in rows)]
    )


def results_of(name):
    """The results of a benchmark as a list of none or one."""
    results = load(name)
    return [results] if results else []


def speed():
    """Rate, and how it compares."""
    for results in results_of("speed"):
        for scene, each in results["scenes"].items():
            renderers = each["renderers"]
            rate = renderers["artist"]["paths_per_cpu_second"]["median"]
            text = f"{rate / 1e6:.2f} million"
            ratios = [
                f"{figures['artist_over_this']['median']:.2f} times {label}"
                for label, figures in renderers.items()
                if label != "artist"
            ]
            yield f"{named(scene)}: paths per CPU second (10 edges)", ", ".join([text, *ratios])


def embree_share():
    """Time over Embree's own."""
    for results in results_of("embree_share"):
        for scene, figures in results["scenes"].items():
            ratio, ns = figures["render_over_embree"]["median"], figures["render_ns_per_ray"]["median"]
            yield (
                f"{named(scene)}: run time over that of Embree alone for the same rays",
                f"{ratio:.2f} ({ns:.0f} ns per ray)",
            )


def start_up():
    """Seconds to wait."""
    for results in results_of("start_up"):
        figures = results["scenes"]["cornell_box"]
        warm, cold = (figures[f"first_sample_{name}_seconds"]["median"] for name in ("warm", "cold"))
        yield "`artist --help`", f"{results['help_seconds']['median']:.2f} s"
        yield "start to first sample, kernels cached / to be compiled", f"{warm:.1f} s / {cold:.0f} s"


def memory():
    """Peak of the demo."""
    for results in results_of("memory"):
        yield "peak memory of `make demo`'s scene", f"{results['peak_bytes']['demo']['cached'] / MIB:.0f} MiB"


def threads():
    """Speed-up of two."""
    for results in results_of("threads"):
        for scene, figures in results["scenes"].items():
            yield f"{named(scene)}: two threads over one", f"{figures['speed_up']['highest']:.2f} times"


def triangles():
    """Growth from few to many."""
    for results in results_of("triangles"):
        for size in results["sizes"]:
            if size["triangles"] >= 100_000:
                cost = f"load and build {size['load_and_build_seconds']:.1f} s, {size['cpu_ns_per_ray']:.0f} ns per ray"
                yield (
                    f"{size['triangles'] / 1e6:.1f} million triangles",
                    f"{cost}, {size['peak_bytes'] / MIB:.0f} MiB",
                )


def named(scene):
    """A scene's name for people."""
    return {"cornell_box": "Cornell box", "glass_sphere": "Cornell box with a glass sphere"}.get(scene, scene)
