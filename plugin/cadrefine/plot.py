"""The convergence plot, from reports."""

import json
import os

from cadrefine.session import Failure


def load_report(path):
    try:
        with open(path, encoding="utf-8") as file:
            report = json.load(file)
        report["steps"][0]["vertices"], report["steps"][0]["global_error"]
        return report
    except (ValueError, KeyError, IndexError, TypeError):
        raise Failure(f"{path}: is not a report written by --report") from None


def plot(report, path, other=None):
    """Global error over the number of vertices, with the slope of second order, as PNG; of an `other` report too."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    runs = [report] + ([other] if other else [])
    figure, axes = pyplot.subplots(figsize=(7.2, 5.0), layout="constrained")
    for run, color in zip(runs, ("tab:blue", "tab:orange")):
        label = "new vertices stay off the CAD" if run.get("no_cad") else "new vertices on the CAD"
        draw_run(axes, run["steps"], color, label)
    draw_slope(axes, report["steps"], -2.0 / report["dimension"])
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("vertices of the mesh")
    axes.set_ylabel(f"{report['error_measure']} between mesh and CAD")
    axes.set_title(f"{os.path.basename(report['mesh'])} on {os.path.basename(report['cad']['file'])}")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend()
    figure.savefig(path, format="png", dpi=150)
    pyplot.close(figure)


def draw_run(axes, steps, color, label):
    """The run's line, its steps marked by their method."""
    shown = [step for step in steps if step["global_error"] and step["global_error"] > 0]
    axes.plot([s["vertices"] for s in shown], [s["global_error"] for s in shown], color=color, label=label)
    for method, marker in (("projection", "D"), ("uniform", "s"), ("longest-edge", "o"), ("quadratic", "^")):
        chosen = [s for s in shown if s.get("method") == method]
        axes.plot([s["vertices"] for s in chosen], [s["global_error"] for s in chosen], marker, color=color,
                  markersize=5, label=None)


def draw_slope(axes, steps, exponent):
    """What second order would do from the first step on."""
    first, last = steps[0], steps[-1]
    if not first["global_error"] or first["vertices"] == last["vertices"]:
        return
    vertices = [first["vertices"], last["vertices"]]
    errors = [first["global_error"], first["global_error"] * (vertices[1] / vertices[0]) ** exponent]
    axes.plot(vertices, errors, "k:", linewidth=1, label="second order")
