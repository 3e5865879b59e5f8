"""The energy balance of runs: no wrong figure beside exit code 0."""
import csv
import json
import math
import random
import unittest

from program import ProgramTest, dssbench

# Strips need several rows.
RANKS = ("--ranks", 2, "--decomposition", "blocks")
WITHOUT_RANKS = dssbench("run", "plate_paper", "--set", "n=8", "--steps", 2, *RANKS).returncode != 0
METHODS = ("rk4", "velocity_verlet", "smoothed_verlet", "symplectic_euler")


def row_of_four(force, damping=0, **run):
    """A clamped row of four elements with the paper's law, pulled at its free end."""
    return {
        "scene": "row",
        "title": "A row of four elements that stiffens when pulled",
        "bodies": [{
            "name": "row", "geometry": {"box": [4, 1, 1]}, "element": 0.1,
            "constants": {"law": "paper", "k": 1e3, "d": damping, "kt": 0.1, "dt": damping / 1e3,
                          "mass": 1, "inertia": 2e-3}
        }],
        "clamps": [{"select": {"face": "-x"}}],
        "loads": [{"select": {"face": "+x"}, "force": force}],
        "run": {"steps": 3000, "dt": 1e-3, **run},
    }


class EnergyBalance(ProgramTest):
    def run_scene(self, scene, *arguments):
        path = self.write("scene.json", json.dumps(scene))
        result = dssbench("run", path, "--json", self.path("out.json"), *arguments)
        try:
            return result, json.loads(self.read("out.json"))
        except FileNotFoundError:
            return result, {}

    def limit(self, method):
        path = self.write("scene.json", json.dumps(row_of_four([0, 0, 0])))
        result = dssbench("stability", path, "--predict", "--integrator", method, "--json", "-")
        return json.loads(result.stdout)["limits"][0]["predicted_dt_s"]

    def test_a_row_that_stiffens_beyond_the_limit_at_rest_never_ends_well(self):
        # The gap becomes as long as an element. RK4 goes non-finite; bounded rotations keep the
        # others finite.
        for method in METHODS:
            scene = row_of_four([100, 30, 20], integrator=method, dt=0.85 * self.limit(method))
            result, record = self.run_scene(scene)
            self.assertIn(result.returncode, (1, 3), method)
            self.assertNotEqual(record["status"], "ok", method)
            if result.returncode == 1:
                self.assertRegex(result.stderr, "energy of .* J at the end is wrong by .* --dt")
                self.assertGreater(record["energy_error"], 0.1)

    def test_the_same_row_is_sound_at_a_shorter_step_and_its_limit_is_told(self):
        for method in METHODS:
            limit = self.limit(method)
            scene = row_of_four([100, 30, 20], integrator=method, dt=0.05 * limit)
            result, record = self.run_scene(scene)
            self.assertEqual((result.returncode, record["status"]), (0, "ok"), result.stderr)
            self.assertLess(abs(record["energy_error"]), 0.02, method)
            self.assertLess(record["stability_limit_end_s"], limit)
            self.assertAlmostEqual(
                record["energy_j"], record["energy_start_j"] + record["work_j"],
                delta=0.03 * record["energy_j"])

    def test_damped_runs_say_what_dampers_took(self):
        result, record = self.run_scene(row_of_four([10, 3, 2], damping=3))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(record["dissipated_j"], 0.1 * record["work_j"])
        self.assertLess(abs(record["energy_error"]), 1e-3)
        self.assertIn("to dampers; error", result.stdout)

    def test_all_variants_and_ranks_have_the_same_balance(self):
        scene = row_of_four([10, 3, 2], damping=3)
        balances = []
        for arguments in (("--variant", "scalar"), ("--variant", "reference"),
                          ("--precision", "f32", "--variant", "scalar"),
                          *(() if WITHOUT_RANKS else (RANKS,))):
            result, record = self.run_scene(scene, *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            balances.append([record[key] for key in ("work_j", "dissipated_j")])
        for balance in balances:
            for one, other in zip(balance, balances[0]):
                self.assertAlmostEqual(one, other, delta=1e-2 * abs(other))

    def test_adaptive_steps_have_a_balance_too(self):
        result, record = self.run_scene(row_of_four([10, 3, 2], damping=3), "--integrator",
                                        "dopri5", "--rtol", "1e-6")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(abs(record["energy_error"]), 1e-3)
        self.assertGreater(record["dissipated_j"], 0)

    def test_long_runs_are_followed_on_the_way(self):
        result, record = self.run_scene(row_of_four([10, 3, 2]), "--steps", "400000", "--dt",
                                        "1e-5")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertLess(abs(record["energy_error"]), 1e-3)
        result, record = self.run_scene(row_of_four([10, 3, 2], damping=3), "--steps", "400000",
                                        "--dt", "1e-5")
        self.assertEqual((result.returncode, record["dissipated_j"]), (0, None))
        self.assertLess(record["energy_error"], 0)

    def test_a_wrong_run_on_ranks_is_told_once_with_the_figures_of_the_root(self):
        if WITHOUT_RANKS:
            self.skipTest("no ranks here")
        scene = row_of_four([100, 30, 20], integrator="velocity_verlet",
                            dt=0.85 * self.limit("velocity_verlet"))
        alone, record = self.run_scene(scene)
        result, on_ranks = self.run_scene(scene, *RANKS)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(on_ranks["reason"], record["reason"])
        self.assertEqual(result.stderr.count("the energy of"), 1, result.stderr)

    def test_a_free_body_that_a_torque_spins_up_over_many_steps_is_sound(self):
        scene = row_of_four([0, 0, 0])
        scene["clamps"], scene["loads"] = [], [{"select": {"all": True},
                                                "torque": [0.002, 0, 0]}]
        result, record = self.run_scene(scene, "--steps", "60000")
        self.assertEqual((result.returncode, record["status"]), (0, "ok"), result.stderr)

    def test_small_rotations_have_no_balance(self):
        result, record = self.run_scene(row_of_four([1, 0.3, 0.2]), "--model", "small")
        self.assertEqual((result.returncode, record["energy_error"]), (0, None), result.stderr)

    def test_numbers_beyond_their_range_are_refused(self):
        fast = row_of_four([0, 0, 0])
        fast["clamps"], fast["initial"] = [], [{"velocity": [1e160, 0, 0]}]
        result, _ = self.run_scene(fast)
        self.assertEqual(result.returncode, 2, result.stdout)
        self.assertIn("beyond the range of numbers", result.stderr)
        small = row_of_four([1, 0, 0])
        small["bodies"][0]["element"] = 1e-160
        for option in ("--state", "--output"):
            file = self.path("small.vtu" if option == "--output" else "small.csv")
            result, _ = self.run_scene(small, option, file, "--steps", "3")
            self.assertNotEqual(result.returncode, 0, result.stdout)
            self.assertNotRegex(result.stdout, "nan|inf")

    def test_no_number_that_is_not_finite_stands_beside_ok(self):
        for velocity in (1e100, 1e150, 1e154, 1e200, 1e300):
            fast = row_of_four([0, 0, 0])
            fast["clamps"], fast["initial"] = [], [{"velocity": [velocity, velocity, 0]}]
            result, record = self.run_scene(fast, "--steps", "10")
            if result.returncode == 0:
                self.assertTrue(math.isfinite(record["energy_j"]))
                self.assertNotRegex(result.stdout, r"\b(nan|inf)\b")

    def test_random_rows_up_to_the_limit_at_rest_end_with_the_work_that_was_done_or_not_well(self):
        # Rows that stiffen, soften or buckle. The work of a constant force is force times
        # displacement, so it needs nothing of the balance.
        chance = random.Random(11)
        endings = []
        for n in range(60):
            method, share = METHODS[n % 4], chance.uniform(0.3, 0.99)
            force = [chance.choice((100, -2, 0.1)) * chance.uniform(0.1, 1.5)] + [
                chance.uniform(-3, 3) for _ in range(2)]
            scene = row_of_four(force, damping=chance.choice((0, 0, 2)), integrator=method,
                                dt=share * self.limit(method), steps=chance.randrange(200, 3000))
            result, record = self.run_scene(scene, "--state", self.path("state.csv"))
            endings.append(result.returncode)
            if result.returncode:
                continue
            tip = list(csv.DictReader(self.read("state.csv").splitlines()))[-1]
            work = sum(f * float(tip[u]) for f, u in zip(force, ("ux", "uy", "uz")))
            where = f"scene {n}, {method} at {share:.2f} of the limit"
            largest = max(record["energy_j"], work, 0.1 * abs(record["work_j"]))
            self.assertAlmostEqual(work, record["work_j"], delta=1e-6 * largest, msg=where)
            wrong = record["energy_j"] - work
            self.assertLess(wrong, 0.1 * largest + 1e-12, where)
            if not scene["bodies"][0]["constants"]["d"]:
                self.assertGreater(wrong, -0.4 * largest - 1e-12, where)
        self.assertEqual(set(endings), {0, 1, 3})
        self.assertGreater(endings.count(0), 30)


if __name__ == "__main__":
    unittest.main()
