#!/usr/bin/python3
"""Where methods are stable: the spectral radius of one step over h omega and damping ratio, with measured limits on theory's line; and what is lost while stable.

Reads results/tables/stability.csv with stability_map.csv and stability_energy.csv beside it, as `dssbench experiment stability` writes them, and nothing else.
Writes OUTPUT and, beside it, OUTPUT's stem + _energy. Left of the line a step shrinks every motion or keeps it; right of it some motion grows.
Example: plots/stability_map.py results/tables/stability.csv --output results/figures/stability_map.png
"""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import pandas  # noqa: E402
from matplotlib.colors import TwoSlopeNorm  # noqa: E402
from picture_command import draw_from_command_line  # noqa: E402
from report.pictures import measured_by, save  # noqa: E402

# Okabe and Ito's colours: told apart with any colour vision.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#000000", "#999999"]
LEVELS = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.98, 1.02, 1.1, 1.2, 1.3, 1.4, 1.5]  # spectral radius
NO_DAMPING = 1e-3  # where zeta = 0 is drawn on a logarithmic axis


def draw_map(axes, theory, measured):
    """One method: colours are |R| of theory, the line its limit, points what runs say."""
    grid = theory.pivot(index="zeta", columns="h_omega", values="spectral_radius")
    shades = TwoSlopeNorm(vmin=0, vcenter=1, vmax=1.5)  # blue shrinks, red grows, white is neither
    colours = axes.contourf(grid.columns, grid.index, grid.to_numpy().clip(max=1.5), levels=LEVELS, cmap="RdBu_r", norm=shades, extend="max")
    limits = theory.groupby("zeta")["limit_h_omega"].first()
    axes.plot(limits, limits.index, color="black", linewidth=1.2, label="limit in theory")
    of_mode, of_scene = measured[measured["is_mode"]], measured[~measured["is_mode"]]
    axes.plot(of_scene["measured_h_omega"], of_scene["zeta"].clip(lower=NO_DAMPING), "D", color="white", markeredgecolor="black", markersize=3.5,
              label="measured: limiting mode of a scene")
    axes.plot(of_mode["measured_h_omega"], of_mode["zeta"].clip(lower=NO_DAMPING), "o", color="black", markersize=4.5, label="measured: one mode")
    axes.set_xscale("log")
    axes.set_yscale("log")
    steps = [step for step in (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50) if grid.columns[0] <= step <= grid.columns[-1]]
    axes.set_xticks(steps, [f"{step:g}" for step in steps])
    axes.set_yticks([NO_DAMPING, 0.01, 0.1, 1, 10], ["0", "0.01", "0.1", "1", "10"])
    axes.minorticks_off()
    axes.set_xlim(grid.columns[0] * 0.9, grid.columns[-1])
    axes.set_ylim(NO_DAMPING / 1.3, grid.index[-1])
    axes.set_xlabel("step times frequency, h omega [rad]")
    return colours


def draw_maps(path, table, theory, output):
    methods = list(dict.fromkeys(theory["integrator"]))
    columns = min(3, len(methods))
    rows = -(-len(methods) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(1.2 + 3.6 * columns, 0.9 + 3.3 * rows), squeeze=False, sharey=True, layout="constrained")
    for axes in grid.flat[len(methods):]:
        axes.set_visible(False)
    for axes, method in zip(grid.flat, methods):
        own = table[(table["integrator"] == method) & table["measured_h_omega"].notna() & (table["measured_h_omega"] > 0)]
        colours = draw_map(axes, theory[theory["integrator"] == method], own)
        axes.set_title(method, fontsize=10, loc="left")
    for axes in grid[:, 0]:
        axes.set_ylabel("damping ratio zeta")
    figure.colorbar(colours, ax=grid, label="spectral radius of one step", shrink=0.8, ticks=[0, 0.2, 0.4, 0.6, 0.8, 1, 1.2, 1.4])
    handles, labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", bbox_to_anchor=(0.5, 1), ncols=3, frameon=False, fontsize=9)
    save(figure, output, measured_by(path), dpi=150, bbox_inches="tight")
    plt.close(figure)


def draw_energy(path, energy, output):
    """Above: what is lost or won a step, linear. Below: its size, logarithmic, to the precision of methods at small steps."""
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 7.5), sharex=True, layout="constrained", height_ratios=[1, 1.1])
    for place, (method, rows) in enumerate(energy.groupby("integrator", sort=False)):
        colour, rows = COLOURS[place % len(COLOURS)], rows.sort_values("h_omega")
        theory, measured = rows["theory_energy_change_per_step"], rows["measured_energy_change_per_step"]
        above.plot(rows["h_omega"], 100 * theory, color=colour, linewidth=1.2)
        above.plot(rows["h_omega"], 100 * measured, "o", color=colour, markersize=3.5, label=method)
        size, seen = theory.abs().where(theory != 0), measured.abs()
        below.plot(rows["h_omega"], 100 * size, color=colour, linewidth=1.2)
        # what a method keeps is measured as the rounding of thousands of steps: no dots below what can be told from it
        below.plot(rows["h_omega"][theory != 0], 100 * seen[theory != 0], "o", color=colour, markersize=3.5)
    above.axhline(0, color="black", linewidth=0.8)
    above.set_ylim(-105, 60)
    above.set_ylabel("energy won in a step [%]\n(negative: lost)")
    most = energy[(energy["integrator"] == "rk4") & ((energy["h_omega"] - 6**0.5).abs() < 1e-9)]
    for _, row in most.iterrows():
        value = 100 * row["measured_energy_change_per_step"]
        above.annotate(f"rk4 at h omega = sqrt 6: {value:.0f} % a step, and stable", (row["h_omega"], value), xytext=(-14, -14),
                       textcoords="offset points", ha="right", va="center", fontsize=9, arrowprops={"arrowstyle": "-", "linewidth": 0.7})
    below.set_yscale("log")
    below.set_ylim(1e-10, 1e3)
    below.set_ylabel("size of the change in a step [%]")
    below.set_xlabel("step times frequency, h omega [rad]")
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    above.legend(frameon=False, fontsize=9, loc="upper left", ncols=2)
    figure.suptitle("Stable is not accurate: energy of one undamped mode. Lines: theory; dots: runs", fontsize=10, x=0.01, ha="left")
    save(figure, output, measured_by(path), dpi=150)
    plt.close(figure)


def draw(path, output):
    """Writes both figures; returns a line that says why there is none, or None."""
    table = pandas.read_csv(path)
    if "predicted_h_omega" not in table.columns or table.empty:
        return f"{path}: no step limits"
    beside = {part: path.with_name(f"{path.stem}_{part}.csv") for part in ("map", "energy")}
    for other in beside.values():
        if not other.exists():
            return f"{other}: no such file; run `dssbench experiment stability`"
    table["is_mode"] = table["set"].fillna("").str.startswith("zeta=")
    output.parent.mkdir(parents=True, exist_ok=True)
    draw_maps(path, table, pandas.read_csv(beside["map"]), output)
    draw_energy(path, pandas.read_csv(beside["energy"]), output.with_name(output.stem.removesuffix("_map") + "_energy" + output.suffix))
    return None


if __name__ == "__main__":
    draw_from_command_line(__doc__, draw, "stability")
