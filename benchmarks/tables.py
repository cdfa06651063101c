"""Tables in Markdown from results/*.json, for README.md here."""

import json

from .measure import HERE, load

README = HERE / "README.md"
BEGIN, END = "<!-- tables: begin; written by python -m benchmarks -->", "<!-- tables: end -->"
MIB = 2**20


def rewrite_readme():
    """Replace what stands between the two marks of README.md."""
    text = README.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    _, after = rest.split(END)
    blocks = [block for block in (write() for write in WRITERS) if block]
    README.write_text(f"{before}{BEGIN}\n{chr(10).join(blocks)}{END}{after}", encoding="utf-8")


def table(title, results, header, rows):
    """A section with one table, and the machine it is from."""
    machine = results["machine"]
    lines = [f"\n### {title}", "", *markdown(header, rows)]
    origin = f"{results['date']}, {machine['processor']}, {machine['processors']} processors"
    return "\n".join([*lines, "", f"{origin}; load average at the end {machine['load_average']}.", ""])


def markdown(header, rows):
    """Lines of a table."""
    lines = [f"| {' | '.join(header)} |", f"|{' --- |' * len(header)}"]
    return lines + [f"| {' | '.join(map(str, row))} |" for row in rows]


def speed():
    """Rates, side by side."""
    if not (results := load("speed")):
        return None
    rows = [
        (
            scene,
            f"{label} {figures['version']}",
            f"{figures['paths_per_cpu_second']['median'] / 1e3:.0f}",
            f"{ratio['median']:.2f} ({ratio['lowest']:.2f} to {ratio['highest']:.2f})",
            " ".join(f"{value:.4f}" for value in figures["mean_rgb"]),
        )
        for scene, each in results["scenes"].items()
        for label, figures in each["renderers"].items()
        for ratio in [figures["artist_over_this"]]
    ]
    header = (
        "scene",
        "renderer",
        "thousand paths per CPU second",
        "artist is faster by",
        "mean radiance, RGB",
    )
    return table("Speed", results, header, rows)


def embree_share():
    """Nanoseconds per ray."""
    if not (results := load("embree_share")):
        return None
    rows = [
        (
            scene,
            f"{figures['render_ns_per_ray']['median']:.0f}",
            f"{figures['embree_ns_per_ray']['median']:.0f}",
            f"{figures['render_over_embree']['median']:.2f}",
            results["target"],
        )
        for scene, figures in results["scenes"].items()
    ]
    header = ("scene", "render, ns per ray", "Embree alone, ns per ray", "ratio", "at most")
    return table("Share of Embree", results, header, rows)


def start_up():
    """Seconds to wait."""
    if not (results := load("start_up")):
        return None
    targets = results["targets"]
    rows = [("`artist --help`", f"{results['help_seconds']['median']:.2f}", targets["help_seconds"])]
    for name, what in (("warm", "first sample, kernels cached"), ("cold", "first sample, kernels compiled")):
        key = f"first_sample_{name}_seconds"
        rows += [
            (f"{what}: {scene}", f"{figures[key]['median']:.2f}", targets[key])
            for scene, figures in results["scenes"].items()
        ]
    return table("Start", results, ("what", "seconds", "at most"), rows)


def memory():
    """MiB."""
    if not (results := load("memory")):
        return None
    limit = f"{results['target_bytes'] / MIB:.0f}"
    rows = [
        (scene, f"{peaks['cached'] / MIB:.0f}", f"{peaks['compiling'] / MIB:.0f}", limit)
        for scene, peaks in results["peak_bytes"].items()
    ]
    return table("Peak memory", results, ("scene", "MiB", "MiB when compiling", "at most"), rows)


def threads():
    """Speed-up."""
    if not (results := load("threads")):
        return None
    rows = [
        (
            scene,
            f"{figures['speed_up']['median']:.2f} (best {figures['speed_up']['highest']:.2f})",
            f"{figures['cpu_time_of_two_over_one']['median']:.2f}",
            results["target"],
        )
        for scene, figures in results["scenes"].items()
    ]
    header = ("scene", "two threads are faster by", "CPU time of two over that of one", "at least")
    return table("Threads", results, header, rows)


def triangles():
    """Growth."""
    if not (results := load("triangles")):
        return None
    rows = [
        (
            f"{each['triangles']:,}".replace(",", " "),
            f"{each['load_and_build_seconds']:.2f}",
            f"{each['cpu_ns_per_ray']:.0f}",
            f"{each['paths_per_cpu_second'] / 1e3:.0f}",
            f"{each['peak_bytes'] / MIB:.0f}",
        )
        for each in results["sizes"]
    ]
    header = ("triangles", "load and build, s", "ns per ray", "thousand paths per CPU second", "peak MiB")
    return table("Growth with triangles", results, header, rows)


def samplers():
    """Errors at equal count and at equal time."""
    if not (results := load("samplers")):
        return None
    counts = [str(count) for count in results["iterations"]]
    parts = []
    for key, what in (("stratified_pairs", "stratified pairs"), ("wavelengths", "wavelengths")):
        rows = [
            (
                scene,
                name,
                *(f"{1e3 * figures[count]['relmse']:.2f}" for count in counts),
                f"{figures[counts[-1]]['cpu_seconds']:.2f}",
                f"{1e3 * figures[counts[-1]]['relmse_times_cpu_seconds']:.1f}",
            )
            for scene, each in results["scenes"].items()
            for name, figures in each[key].items()
        ]
        header = ("scene", what, *(f"1000 relMSE, {n} paths" for n in counts), "CPU s", "1000 relMSE x CPU s")
        parts.append(table(f"Error by {what}", results, header, rows))
    return "\n".join(parts)


def luxcore():
    """Rates and errors, side by side."""
    if not (results := load("luxcore")):
        return None
    rows = []
    for integrator, each in results["pairs"].items():
        for name, figures in each["renderers"].items():
            is_ours = name == integrator
            ratio = each["rate_ratio"]
            rows.append(
                (
                    f"{'artist' if is_ours else 'LuxCore'} {figures['version']} {name}",
                    f"{figures['samples_per_cpu_second']['median'] / 1e3:.0f}",
                    f"{ratio['median']:.1f} ({ratio['lowest']:.1f} to {ratio['highest']:.1f})"
                    if is_ours
                    else "",
                    f"{figures['relmse']:.4f}",
                    f"{each['error_ratio']:.1f}" if is_ours else "",
                    f"{figures['mean_radiance']:.4f}",
                )
            )
    seconds = results["cpu_seconds"]
    header = (
        "renderer",
        "thousand samples per CPU second",
        "times as many",
        f"relMSE after {seconds} CPU s",
        "times less error",
        "mean radiance",
    )
    return table("Beside LuxCore", results, header, rows)


def boxes():
    """Error against CPU seconds on the reference boxes."""
    if not (results := load("boxes")):
        return None
    seconds = results["seconds"]
    rows = [
        (
            each["box"],
            each["integrator"],
            f"{each['pairs_per_cpu_second'] / 1e3:.0f}",
            *(f"{row['relmse']:.4f}" for row in each["rows"]),
        )
        for each in results["runs"]
    ]
    rows += [
        (box, "the references' own disagreement", "", *[f"{value:.4f}"] * len(seconds))
        for box, value in results["disagreement"].items()
    ]
    header = ("box", "integrator", "thousand pairs per CPU s", *(f"relMSE, {each:g} s" for each in seconds))
    return table("Reference boxes, 512 x 512", results, header, rows)


def correlation():
    """Noise at equal time."""
    if not (results := load("correlation")):
        return None
    rows = [
        (
            scene,
            f"{1e3 * figures['none']['relmse']:.2f} / {1e3 * figures['vcm+']['relmse']:.2f}",
            f"{figures['none']['cpu_seconds']:.1f} / {figures['vcm+']['cpu_seconds']:.1f}",
            f"{figures['none_over_vcm+']:.2f} +- {figures['standard_error']:.2f}",
        )
        for scene, figures in results["scenes"].items()
    ]
    header = (
        "scene",
        f"1000 relMSE, {results['iterations']} iterations, none / vcm+",
        "CPU s",
        "relMSE x CPU s, none over vcm+",
    )
    return table("Weights that know of shared photons", results, header, rows)


def published():
    """Error at equal time of fluorescence by shared sets, and by published ways."""
    if not (results := load("published")):
        return None
    first, radii = results["radii"][0], results["radii"]
    rows = [
        (
            scene,
            f"{seconds:g}",
            *_against(errors["pt"], errors["pt, shifting"]),
            *_against(errors[f"ppm, {first}"], errors[f"ppm, one wavelength, {first}"]),
            *_against(
                *(min(errors[f"{kind}, {r}"] for r in radii) for kind in ("ppm", "ppm, one wavelength"))
            ),
            *_against(errors["vcm"], min(errors[f"ppm, one wavelength, {r}"] for r in radii)),
            f"{1e3 * figures['reference_relmse']:.2g}",
        )
        for scene, figures in results["scenes"].items()
        for i, seconds in enumerate(results["seconds"])
        for errors in [{label: each[i] for label, each in figures["relmse"].items()}]
    ]
    header = (
        "scene",
        "CPU s",
        "1000 relMSE: pt, sets / shifting",
        "times less",
        f"ppm, sets / one wavelength, radius {first}",
        "times less",
        f"the better radius of {' and '.join(map(str, radii))} for either",
        "times less",
        "vcm, sets / the better ppm, one wavelength",
        "times less",
        "the reference's own",
    )
    return table("Fluorescence by shared sets and by published ways", results, header, rows)


def fluorescence_cost():
    """Ratios to white paint."""
    if not (results := load("fluorescence_cost")):
        return None
    rows = [
        (
            label,
            f"{figures['time']['median']:.2f} ({figures['time']['lowest']:.2f} to {figures['time']['highest']:.2f})",
            f"{figures['memory']['ratio']:.2f} ({figures['memory']['bytes'] / MIB:.0f} MiB)",
            f"{figures['memory']['stored_ratio']:.2f}",
        )
        for label, figures in results["scenes"].items()
    ]
    targets = results["targets"]
    header = (
        "scene",
        f"times the CPU time of an iteration with white paint (at most {targets['time']})",
        f"times the peak memory (at most {targets['memory']})",
        "of what a render stores alone",
    )
    return table("Cost of fluorescence", results, header, rows)


def colour_control():
    """Noise with and without control."""
    if not (results := load("colour_control")):
        return None
    rows = [
        (
            scene,
            iterations,
            *(
                f"{100 * figures['without'][what][i]:.2g} / {100 * figures['with'][what][i]:.2g}"
                for what in ("mean", "pixel")
            ),
        )
        for scene, figures in results["scenes"].items()
        for i, iterations in enumerate(results["iterations"])
    ]
    header = (
        "scene",
        "iterations",
        "deviation of the image's mean from seed to seed, %: without / with control",
        "of its pixels",
    )
    return table("Control of colour", results, header, rows)


def _against(ours, theirs):
    """`(both errors, how many times less ours is)`."""
    return f"{1e3 * ours:.3g} / {1e3 * theirs:.3g}", f"{theirs / ours:.3g}"


def findings():
    """Error against CPU seconds, a table per run of `artist converge`."""
    parts = []
    for path in sorted((HERE / "findings").glob("*/convergence.json")):
        results = json.loads(path.read_text(encoding="utf-8"))
        marks = results["marks"]
        relmse = {(row["entry"], row["mark"]): row for row in results["summary"]}
        rows = [
            (
                entry["label"],
                *(f"{relmse[entry['label'], mark]['relmse']:.2g}" for mark in marks),
                f"{relmse[entry['label'], marks[-1]]['smape']:.2f}",
                slope_text(entry["slopes"]["relmse"]),
            )
            for entry in results["entries"]
        ]
        header = ("", *(f"relMSE, {mark:g} CPU s" for mark in marks), f"sMAPE, {marks[-1]:g} CPU s", "slope")
        reference = results["reference"]
        about = (
            f"![{path.parent.name}](findings/{path.parent.name}/plot.svg)\n\n"
            f"Reference: {' and '.join(reference['integrators'])}, own relMSE {reference['relmse']:.1g}."
        )
        parts.append("\n".join([f"\n### {path.parent.name}", "", about, "", *markdown(header, rows), ""]))
    return "\n".join(parts)


def ablations():
    """What features cost that a scene does not need, a table per scene."""
    parts = []
    for path in sorted((HERE / "findings").glob("*/ablation.json")):
        rows = [
            (
                cost["entry"],
                cost["feature"],
                f"{1e3 * cost['cpu_without']:.1f} / {1e3 * cost['cpu_with']:.1f}",
                f"{cost['ratio']:.2f} ({cost['ratio_low']:.2f} to {cost['ratio_high']:.2f})",
                f"{cost['compile_without']:.1f} / {cost['compile_with']:.1f}" if cost["compile_with"] else "",
            )
            for cost in json.loads(path.read_text(encoding="utf-8"))["costs"]
        ]
        header = (
            "",
            "forced in",
            "CPU ms per iteration, without / with",
            "ratio",
            "compile CPU s, without / with",
        )
        parts.append("\n".join([f"\n### {path.parent.name}", "", *markdown(header, rows), ""]))
    return "\n".join(parts)


def slope_text(slope):
    """The fitted exponent of the seconds, where there is one."""
    return f"{slope['median']:.2f}" if slope else ""


WRITERS = (
    speed,
    luxcore,
    boxes,
    embree_share,
    start_up,
    memory,
    threads,
    triangles,
    samplers,
    correlation,
    published,
    fluorescence_cost,
    colour_control,
    findings,
    ablations,
)
