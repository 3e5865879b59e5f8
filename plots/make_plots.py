#!/usr/bin/python3
"""All figures of a directory of results: a bar chart for each table, lines over ranks and over sizes where it has them, pictures of each .vtu and .pvd in fields/.

Reads DIR/tables/*.csv and DIR/fields/, writes DIR/figures/. No solver runs.
Example: plots/make_plots.py --results results
"""
import argparse
import pathlib
import sys

import advice
import balance_lines
import body_picture
import cluster_lines
import continuum
import error_budget
import failure_atlas
import figure9_lines
import model_ladder
import scaling_lines
import speedup_bars
import stability_map
import statics
import work_precision


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=pathlib.Path, default=pathlib.Path("results"), help="directory with tables/ and fields/")
    arguments = parser.parse_args()
    results = arguments.results
    tables, fields = sorted((results / "tables").glob("*.csv")), results / "fields"
    if not tables and not any(fields.glob("*.vtu")):
        sys.exit(f"{results}: no tables/*.csv and no fields/*.vtu; run `dssbench experiment` first")
    for table in tables:
        output = results / "figures" / f"{table.stem}.png"
        if table.stem.endswith("_simulated"):
            print(cluster_lines.draw(table, output) or output)
            continue
        if table.stem in ("stability_energy", "stability_map"):  # drawn with stability.csv
            continue
        if stability_map.draw(table, results / "figures" / f"{table.stem}_map.png") is None:
            print(results / "figures" / f"{table.stem}_map.png")
            continue
        if table.stem in ("kernels", "ceilings", "attribution", "chain"):  # charts of the report alone
            continue
        if table.stem.startswith("work_precision_"):  # what the chart shows already, in words
            continue
        if any(kind.draw(table, output) is None for kind in (advice, balance_lines, failure_atlas, continuum, statics, work_precision, error_budget, model_ladder)):
            print(output)
            continue
        print(speedup_bars.draw(table, None, output) or output)
        output = results / "figures" / f"{table.stem}_scaling.png"
        if scaling_lines.draw(table, output) is None:  # most tables have no ranks
            print(output)
        output = results / "figures" / f"{table.stem}_figure9.png"
        if figure9_lines.draw(table, output) is None:  # most tables have no plates of the paper's figure
            print(output)
    for output in body_picture.draw_all(fields, results / "figures"):
        print(output)


if __name__ == "__main__":
    main()
