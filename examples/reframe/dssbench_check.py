"""ReFrame checks of dssbench: the same states as the oracle, and the speed of each variant.

    reframe -c examples/reframe/dssbench_check.py -r

`dssbench` must be on the path, on a machine like those that compute. References of speed come from
a table that was measured there, if DSSBENCH_REFERENCES names one, such as
results/tables/geometry.csv. Without a table the speeds are only reported.
"""
import csv
import json
import os
import subprocess

import reframe as rfm
import reframe.utility.sanity as sn
from reframe.core.builtins import (parameter, performance_function, run_before, sanity_function,
                                   variable)

UNIT = "element-steps/s"
CELL = {"scene": "plate_paper", "set": "n=100", "threads": "1", "ranks": "1", "model": "spatial",
        "precision": "f64", "integrator": "rk4", "status": "ok"}


@rfm.simple_test
class StatesOfTheOracle(rfm.RunOnlyRegressionTest):
    """Every variant on this machine computes the states of the oracle."""
    descr = "dssbench verify"
    valid_systems, valid_prog_environs = ["*"], ["*"]
    executable, executable_opts = "dssbench", ["verify", "plate_paper", "--quiet"]

    @sanity_function
    def none_failed(self):
        """The last line counts them."""
        return sn.assert_found(r"[1-9]\d* checks passed, 0 failed", self.stdout)


@rfm.simple_test
class SpeedOfAVariant(rfm.RunOnlyRegressionTest):
    """The plate n = 100 with RK4 on one thread."""
    kind = parameter(["scalar", "avx2", "avx512"])
    tolerance = variable(float, value=0.1)  # how much slower than the reference a run may be
    valid_systems, valid_prog_environs = ["*"], ["*"]
    executable = "dssbench"

    @run_before("run")
    def set_options(self):
        """One run; its record goes to record.json."""
        self.descr = f"speed of {self.kind}"
        self.executable_opts = ["run", CELL["scene"], "--set", CELL["set"], "--variant", self.kind,
                                "--threads", CELL["threads"], "--model", CELL["model"],
                                "--precision", CELL["precision"], "--integrator",
                                CELL["integrator"], "--repeat-for", "2", "--json", "record.json"]
        self.skip_if(self.kind not in self.usable(), f"this machine cannot run {self.kind}")

    @staticmethod
    def usable():
        """Names of the variants that run here."""
        words = ["dssbench", "list", "variants", "--json"]
        listed = subprocess.run(words, capture_output=True, text=True, check=True).stdout
        return [row["variant"] for row in json.loads(listed) if row["status"] == "usable"]

    @run_before("performance")
    def set_reference(self):
        """The reference of this variant in the table that DSSBENCH_REFERENCES names."""
        path = os.environ.get("DSSBENCH_REFERENCES")
        if not path:
            return
        with open(path, encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["variant"] == self.kind
                    and all(row.get(key) == value for key, value in CELL.items())]
        if not rows:
            raise LookupError(f"{path} has no row of {self.kind}")
        self.reference = {"*": {"rate": (float(rows[0]["element_steps_per_s"]), -self.tolerance,
                                         None, UNIT)}}

    @sanity_function
    def ended_well(self):
        """The run ended with the status ok."""
        return sn.assert_found(r'"status": *"ok"', "record.json")

    @performance_function(UNIT)
    def rate(self):
        """The rate of the run."""
        return sn.extractsingle(r'"element_steps_per_s": *([-+.e\d]+)', "record.json", 1, float)
