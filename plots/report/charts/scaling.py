"""Speed-up over ranks, strong scaling, by halo strategy."""
import pandas
from scaling_lines import OTHER_STYLE, STYLES, strong_panels

from ..results import NotMeasured
from .chart import Chart, Filter, linear, points, whiskers

COLUMNS = {"label": "cell", "set": "set", "ranks": "ranks", "halo": "halo", "halo_used": "halo that ran", "measured_wall_s": "median time [s]", "point": "against 1 rank",
           "speedup_vs_1_rank_low": "from", "speedup_vs_1_rank_high": "to", "parallel_efficiency": "efficiency", "communication_share": "share of time in exchanges", "status": "status"}
SYMBOLS = {"s": "square", "^": "triangle-up", "o": "circle", "D": "diamond", "v": "triangle-down", "P": "cross", "x": "x"}


def traces_of(rows, table):
    """A line a halo strategy; hollow where there are more workers than cores."""
    for halo, line in rows.groupby("halo", sort=False):
        colour, marker = STYLES.get(halo, OTHER_STYLE)
        symbols = [SYMBOLS[marker] + ("-open" if hollow else "") for hollow in line["is_hollow"]]
        yield points(line, table, "ranks", "point", ["variant", "halo"], COLUMNS, mode="lines+markers", name=halo, legendgroup=halo, line={"color": colour, "width": 1.3},
                     marker={"size": 10, "symbol": symbols, "line": {"width": 2, "color": colour}}, error_y=whiskers(line, "point", "speedup_vs_1_rank_low", "speedup_vs_1_rank_high"))


def scaling(table):
    def make(results):
        frame = results.table(table, "source", "label", "ranks", "halo", "decomposition", "speedup_vs_1_rank", "element_steps_per_s", "status", "cores", "threads")
        frame = frame[(frame["source"] == "measured") & frame["element_steps_per_s"].notna() & ~frame["label"].fillna("").str.contains("A/A", regex=False)]
        panels = list(strong_panels(frame[frame["status"].isin(["ok", "oversubscribed"])]))
        if not panels:
            raise NotMeasured("no cell on several ranks has its like on one")
        rows = pandas.concat([own for _, own in panels])
        traces = [trace for _, own in panels for trace in traces_of(own, table)]
        most, cores = int(rows["ranks"].max()), int(rows["cores"].max())
        traces.append({"type": "scatter", "x": [1, most], "y": [1, most], "mode": "lines", "name": "ideal", "line": {"color": "soft", "dash": "dot", "width": 1}, "meta": {}, "hoverinfo": "skip"})
        best = rows[~rows["is_hollow"]]
        words = "" if best.empty else f" The best counted one is {best['point'].max():.3g} ({best.loc[best['point'].idxmax(), 'label']})."
        text = (f"Speed-up against one rank of the same variant, medians of paired ratios with 95 % intervals. Hollow marks have more workers than the {cores} cores: ratios of rates, no speed-ups.{words}")
        layout = {"xaxis": linear("ranks", dtick=1), "yaxis": linear("speed-up against 1 rank", rangemode="tozero")}
        return Chart(text, table, traces, layout, rows, COLUMNS, [Filter("variant", "Variant"), Filter("halo", "Halo strategy")])
    return make
