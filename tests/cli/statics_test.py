"""States of rest and natural modes from the command line."""
import csv
import json
import os
import unittest

from program import ProgramTest, dssbench

BEAM = ("run", "cantilever_beam", "--set", "n=6")
STATIC = (*BEAM, "--analysis", "static")
MODAL = (*BEAM, "--analysis", "modal")


class Statics(ProgramTest):
    def record(self, *arguments):
        result = dssbench(*arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_every_solver_gives_a_record(self):
        deflections = {}
        for solver in ("direct", "cg", "newton", "relaxation", "auto"):
            record = self.record(*STATIC, "--solver", solver)
            self.assertEqual((record["analysis"], record["status"]), ("static", "ok"))
            self.assertEqual(record["solver"], "newton" if solver == "auto" else solver)
            self.assertLess(record["residual"], 1e-9)
            deflections[solver] = record["max_displacement_m"]
        self.assertAlmostEqual(deflections["direct"], deflections["cg"], delta=1e-12)
        self.assertAlmostEqual(deflections["newton"], deflections["relaxation"], delta=1e-10)

    def test_auto_takes_the_plane_where_that_is_proven_and_looks_out_of_it(self):
        plate = ("run", "plate_paper", "--set", "n=8", "--analysis", "static")
        chosen, whole = self.record(*plate), self.record(*plate, "--model", "spatial")
        self.assertEqual((chosen["model"], whole["model"]), ("planar", "spatial"))
        self.assertIn("proven", chosen["model_why"])
        self.assertAlmostEqual(chosen["max_displacement_m"] / whole["max_displacement_m"],
                               1,
                               delta=1e-12)
        self.assertIn("out of its plane", chosen["note"])  # the paper's links do not resist bending
        self.assertEqual(self.record(*STATIC)["model"], "spatial")
        for linear in (("--solver", "cg"), ("--solver", "direct", "--set", "run.model=planar")):
            self.assertEqual(self.record(*plate, *linear)["model"], "membrane")
        relaxed = self.record(*plate, "--solver", "relaxation")
        self.assertEqual(relaxed["model"], "planar")
        self.assertIn("out of its plane is not known", relaxed["note"])

    def test_clamps_balance_the_load_at_rest(self):
        centre = (5.5 / 6, 0.025, 0.025)  # of the loaded element; the load is (0, 0, -1) N
        record = self.record(*STATIC, "--model", "linear")
        for got, expected in zip(record["reaction_force_n"], (0, 0, 1)):
            self.assertAlmostEqual(got, expected, delta=1e-8)
        for got, expected in zip(record["reaction_moment_n_m"], (centre[1], -centre[0], 0)):
            self.assertAlmostEqual(got, expected, delta=1e-8)
        self.assertIn("clamps exert a force of (", dssbench(*STATIC).stdout)

    def test_a_run_tells_the_reactions_of_its_end(self):
        record = self.record(*BEAM, "--analysis", "dynamic", "--steps", "400")
        self.assertEqual(len(record["reaction_force_n"]), 3)
        self.assertNotEqual(record["reaction_force_n"][2], 0)
        box = self.record("run", "tumbling_box", "--steps", "2")
        self.assertIsNone(box["reaction_force_n"])

    def test_the_state_and_the_picture_are_of_the_state_of_rest(self):
        result = dssbench(*STATIC, "--state", self.path("rest.csv"), "--output",
                          self.path("rest.vtu"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("rest.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 6)
        self.assertLess(float(rows[-1]["uz"]), -0.03)
        self.assertEqual({float(row["vz"]) for row in rows}, {0.0})
        self.assertTrue(os.path.getsize(self.path("rest.vtu")) > 0)

    def test_modes_are_listed_and_drawn(self):
        record = self.record(*MODAL, "--modes", "4", "--output", self.path("mode.vtu"))
        frequencies = [mode["frequency_hz"] for mode in record["modes"]]
        self.assertEqual(len(frequencies), 4)
        self.assertEqual(frequencies, sorted(frequencies))
        self.assertEqual(record["free_motions"], 0)
        self.assertEqual(
            sorted(name for name in os.listdir(self.directory) if name.startswith("mode")),
            ["mode.pvd", *(f"mode_{n:04}.vtu" for n in range(4))])
        # A square beam has equal pairs. One follows the frame along y, the other along z.
        masses = [[round(mass, 9)
                   for mass in mode["effective_mass_kg"]]
                  for mode in record["modes"][:2]]
        self.assertEqual({tuple(mass > 0
                                for mass in of_mode)
                          for of_mode in masses}, {(False, True, False), (False, False, True)})

    def test_a_scene_says_its_analysis_and_the_option_says_another(self):
        self.assertEqual(self.record(*BEAM, "--set", "run.analysis=modal")["analysis"], "modal")
        self.assertEqual(
            self.record(*BEAM, "--set", "run.analysis=modal", "--analysis", "static")["analysis"],
            "static")

    def test_loads_prestress_a_beam(self):
        pulled = [
            self.record(*MODAL, "--prestressed", "--set", f"loads.0.force.0={force}", "--set",
                        "force=0")["modes"][0]["omega_rad_s"] for force in (-1, 0, 1)
        ]
        self.assertEqual(pulled, sorted(pulled))

    def test_problems_without_one_answer_are_refused_by_name(self):
        self.assert_refused(2, ['body "box" is free to', "clamp it"], "run", "tumbling_box",
                            "--analysis", "static")
        block = ("run", "block", "--set", "nx=4", "--set", "ny=4", "--set", "nz=4", "--analysis",
                 "static")
        self.assert_refused(2, ['of body "block"', "mechanism", "--solver cg"], *block, "--solver",
                            "direct")
        self.assertIn("mechanism", self.record(*block)["note"])  # which no load drives
        self.assert_refused(2, ["mechanisms", "--model planar"], "run", "plate_paper", "--set",
                            "n=12", "--analysis", "modal")
        self.assert_refused(3, ["buckle", "smaller"], *STATIC, "--set", "loads.0.force.0=-40",
                            "--set", "force=0")

    def test_what_does_not_converge_exits_1_with_how_far_it_came(self):
        result = dssbench(*STATIC, "--solver", "relaxation", "--steps", "20", "--json",
                          self.path("record.json"))
        self.assertEqual(result.returncode, 1)
        self.assertIn("after 20 steps", result.stderr)
        self.assertEqual(json.loads(self.read("record.json"))["status"], "not converged")

    def test_options_without_a_part_in_the_analysis_are_refused(self):
        self.assert_refused(2, ["--dt", "--analysis static"], *STATIC, "--dt", "1e-3")
        self.assert_refused(2, ["--variant", "--solver auto"], *STATIC, "--variant", "reference")
        self.assert_refused(2, ["--state", "modal"], *MODAL, "--state", self.path("s.csv"))
        self.assert_refused(2, ["--modes", "only with"], *BEAM, "--modes", "3")
        self.assert_refused(2, ["--solver", "only with"], *BEAM, "--solver", "cg")
        self.assert_refused(2, ["moda", '"modal"'], *BEAM, "--analysis", "moda")
        self.assert_refused(2, ["newtn", '"newton"'], *STATIC, "--solver", "newtn")
        self.assert_refused(2, ["--solver direct", "--model linear"], *STATIC, "--solver", "direct",
                            "--model", "spatial")
        self.assert_refused(2, ["--solver newton", "linear"], *STATIC, "--solver", "newton",
                            "--model", "linear")
        self.assert_refused(2, ["--modes 0"], *MODAL, "--modes", "0")
        self.assert_refused(2, ["--model axial", "load 0"], *STATIC, "--model", "axial")

    def test_the_shipped_study_passes(self):
        result = dssbench("experiment", "statics", "--scale", "smoke", "--out", self.directory)
        self.assertEqual(result.returncode, 0, result.stdout)
        with open(self.path("tables/statics.csv"), encoding="utf-8") as file:
            self.assertEqual({row["status"] for row in csv.DictReader(file)}, {"passed", "linear"})


if __name__ == "__main__":
    unittest.main()
