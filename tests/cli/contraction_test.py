"""Bodies of the law solid with nu > 0: they contract across a pull."""
import csv
import json
import pathlib
import unittest

from program import ProgramTest, dssbench, why_no_variant

ROOT = pathlib.Path(__file__).resolve().parents[2]
BLOCK = ROOT / "experiments" / "scenes" / "continuum" / "pulled_block.json"


class Contraction(ProgramTest):
    def state(self, *arguments):
        result = dssbench("run", BLOCK, "--model", "linear", *arguments, "--state",
                          self.path("state.csv"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("state.csv"), encoding="utf-8") as file:
            return [{key: float(value)
                     for key, value in row.items() if key != "body"}
                    for row in csv.DictReader(file)]

    def test_a_pulled_block_has_the_strains_of_its_material(self):
        for nu in (0, 0.3, 0.45):
            last = self.state("--set", f"nu={nu}", "--solver", "direct")[-1]
            self.assertAlmostEqual(last["ux"] / (1e-6 * 7 * 0.01), 1, delta=1e-4)
            for across in ("uy", "uz"):
                self.assertAlmostEqual(last[across] / (1e-6 * 3 * 0.01), -nu, delta=1e-4)

    def moved(self, *arguments):
        result = dssbench("run", BLOCK, "--analysis", "dynamic", "--set", "n=3", "--json", "-",
                          *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        record = json.loads(result.stdout)
        self.assertGreater(record["energy_j"], 0)
        return record

    def test_its_motion_keeps_its_energy_to_the_order_of_the_method(self):
        first = self.moved("--integrator", "rk4")
        self.assertEqual(first["model"], "spatial")
        self.assertLess(abs(first["energy_error"]), 1e-6)
        dt, steps = 4 * first["dt_s"], first["steps"] // 4
        errors = [abs(self.moved("--integrator", "rk4", "--dt", str(dt / by), "--steps",
                                 str(steps * by))["energy_error"]) for by in (1, 2)]
        self.assertGreater(errors[0] / errors[1], 14)

    def test_the_oracle_has_the_same_energy(self):
        energies = [self.moved("--variant", variant)["energy_j"]
                    for variant in ("reference", "scalar")]
        self.assertAlmostEqual(energies[0] / energies[1], 1, delta=1e-9)

    def test_a_step_beyond_the_limit_that_follows_from_nu_is_refused(self):
        limits = []
        for nu in ("0.3", "0.49"):
            result = dssbench("run", BLOCK, "--analysis", "dynamic", "--variant", "reference",
                              "--set", "n=6", "--set", f"nu={nu}", "--dt", "1")
            self.assertNotEqual(result.returncode, 0)
            limits.append(float(result.stderr.split("stability limit ")[1].split()[0]))
        # omega^2 of large blocks is 28 mu / rho h^2 for nu = 0.3, (12 mu + 3 lambda) / rho h^2 for
        # 0.49, with mu = E / 2(1 + nu).
        large = ((12 + 3 * 49) / 28 * 1.3 / 1.49)**0.5
        self.assertAlmostEqual(limits[0] / limits[1] / large, 1, delta=0.1)

    def test_variants_agree_with_the_oracle(self):
        here = [name for name in ("scalar", "avx2", "avx512") if why_no_variant(name) is None]
        for more in (["--variant", ",".join(["as_published", "reference", *here])],
                     ["--ranks", "3"]):  # devices: see the equivalence tests
            if "--ranks" in more and why_no_variant("mpi"):
                continue
            result = dssbench("verify", BLOCK, *more)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertRegex(result.stdout, "[1-9][0-9]+ checks passed, 0 failed")
            self.assertNotIn("nu > 0", result.stdout)

    def test_other_laws_say_that_they_lack_it(self):
        result = dssbench("run", BLOCK, "--set", "bodies/0/constants/law=material")
        self.assertIn("no lateral contraction; give G in place of nu", result.stderr)

    def test_a_chain_has_no_pressure_and_runs_on_every_variant(self):
        chain = dssbench("run", BLOCK, "--analysis", "dynamic", "--variant", "scalar", "--set",
                         "n=1")
        self.assertEqual(chain.returncode, 0, chain.stderr)

    def test_explain_lists_pressures_and_why_smaller_models_do_not_do(self):
        shown = dssbench("explain", BLOCK)
        self.assertIn("pressures of elements, from nu", shown.stdout)
        explained = json.loads(dssbench("explain", BLOCK, "--json", "-").stdout)
        self.assertTrue(explained["terms"]["pressure of elements"]["is_needed"])
        inner = max(explained["pressures"], key=lambda kind: kind["volume_pa"])
        shear = 1e7 / 2.6
        self.assertAlmostEqual(inner["volume_pa"] / (2 * shear * 0.3 / 0.4), 1)
        self.assertEqual(sum(kind["count"] for kind in explained["pressures"]), 128)


if __name__ == "__main__":
    unittest.main()
