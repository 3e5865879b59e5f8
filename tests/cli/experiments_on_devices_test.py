"""`experiment`: cells on devices and hybrids, and the model of their balance."""
import json
import unittest

from program import dssbench
from tiny_study import SIX, TinyStudyTest


class ExperimentsOnDevices(TinyStudyTest):
    def blocks(self, *more):
        self.study(cells=[{"scene": "plate_paper", "set": {"n": [10]}, "variants": ["scalar"]},
                          *more],
                   base=["scalar"],
                   twin="scalar", scales={"smoke": SIX})

    def test_without_its_device_a_cell_is_unavailable_and_the_study_succeeds(self):
        plate = {"scene": "plate_paper", "set": {"n": [10]}}
        self.blocks({**plate, "variants": ["opencl", "opencl-rhs"], "device": "no such device"},
                    {**plate, "hybrid": ["scalar,opencl@[9:9]"]},
                    {**plate, "hybrid": "auto", "device": "no such device"})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        for name in ("raw", "tables"):
            absent = [row for row in self.rows(name) if row["status"] == "unavailable"]
            self.assertEqual(len(absent), 4)
            for row in absent:
                self.assertNotEqual(row["reason"], "")
                for column in ("wall_s", "measured_wall_s", "device_used", "members"):
                    self.assertEqual(row.get(column, ""), "", column)
        self.assertEqual(
            {row["status"] for row in self.rows("tables") if row["variant"] == "scalar"}, {"ok"}
        )
        self.assertIn("unavailable: ", result.stdout)

    def test_cells_on_devices_have_their_costs_and_hybrids_their_shares(self):
        listed = json.loads(dssbench("list", "devices", "--json").stdout)
        if not any(device["kind"] == "cpu" and device["status"] == "usable"
                   for device in listed[1:]):
            self.skipTest("no OpenCL device of the kind cpu")
        plate = {"scene": "plate_paper", "set": {"n": [10]}}
        self.blocks({**plate, "variants": ["opencl", "opencl-rhs"], "device": "cpu"},
                    {**plate, "variants": ["avx2"]}, {**plate, "hybrid": "avx2:1,opencl@cpu:1"})
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        table = {row["variant"]: row for row in self.rows("tables") if row["source"] == "measured"}
        for variant in ("opencl", "opencl-rhs"):
            row = table[variant]
            self.assertEqual((row["device"], row["status"], row["check"]), ("cpu", "ok", "passed"))
            for column in ("launch_us", "first_step_s", "build_s", "triad_bytes_per_s",
                           "bandwidth_share", "peak_share"):
                self.assertGreater(float(row[column]), 0, column)
        self.assertGreater(float(table["opencl-rhs"]["to_device_bytes_per_step"]),
                           float(table["opencl"]["to_device_bytes_per_step"]))
        self.assertGreater(float(table["opencl-rhs"]["speedup_vs_resident"]), 0)
        hybrid = table["hybrid"]
        self.assertRegex(hybrid["members"], r"^avx2:1 0\.\d+; opencl@cpu:1 0\.\d+$")
        self.assertGreater(float(hybrid["of_sum_of_members"] or 1), 0)
        self.assertIn("On devices", result.stdout)
        self.assertIn("Hybrids", result.stdout)

    def test_a_balance_is_modelled(self):
        balance = {
            "slow_element_steps_per_s": 1e8, "speed_ratios": [1, 50], "n": [50],
            "links": [{"label": "L", "latency_us": 10, "gb_per_s": 12}]
        }
        self.write(
            "tiny.json",
            json.dumps(
                {"experiment": "tiny", "title": "T", "balance": balance, "scales": {"smoke": {}}}))
        result = self.experiment()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({row["status"] for row in self.rows("tables")}, {"modelled"})
        self.write(
            "tiny.json",
            json.dumps({
                "experiment": "tiny", "title": "T", "balance": {**balance, "speed_ratios": [0]},
                "scales": {"smoke": {}}
            }))
        self.assert_refused(2, ["/balance/speed_ratios", "0"], "experiment", self.path("tiny.json"),
                            "--scale", "smoke")


if __name__ == "__main__":
    unittest.main()
