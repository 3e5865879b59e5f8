"""The variant `sparse` by the command line."""
import json
import unittest

from program import ProgramTest, dssbench, shipped_scene

PLATE = ("run", "plate_paper", "--set", "n=10", "--steps", "40", "--variant", "sparse")


class Sparse(ProgramTest):
    def record(self, *arguments):
        result = dssbench(*arguments, "--json", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def test_it_runs_each_implicit_method_beyond_the_limit_of_explicit_ones(self):
        for method in ("newmark", "generalized_alpha", "implicit_midpoint", "sdirk4"):
            record = self.record(*PLATE, "--model", "membrane", "--integrator", method, "--dt",
                                 "1e-5")
            self.assertEqual((record["variant"], record["status"]), ("sparse", "ok"))
            self.assertIn("sparse factors: ", record["schedule"])
            other = self.record("run", "plate_paper", "--set", "n=10", "--steps", "40", "--model",
                                "membrane", "--variant", "reference", "--integrator", method,
                                "--dt", "1e-5")
            self.assertAlmostEqual(
                record["max_displacement_m"] / other["max_displacement_m"], 1, delta=1e-9)

    def test_the_radius_of_generalized_alpha_is_part_of_its_name(self):
        run = (*PLATE, "--model", "membrane", "--dt", "1e-4", "--integrator")
        records = [self.record(*run, f"generalized_alpha{radius}") for radius in ("", ":0.8", ":0")]
        self.assertEqual([record["integrator"] for record in records],
                         ["generalized_alpha", "generalized_alpha:0.8", "generalized_alpha:0"])
        digests = [record["state_digest"] for record in records]
        self.assertEqual(digests[0], digests[1])
        self.assertNotEqual(digests[0], digests[2])
        scene = self.scene_of("plate_paper", integrator="generalized_alpha:0.8")
        own = self.record("run", scene, *PLATE[2:], "--model", "membrane", "--dt", "1e-4")
        self.assertEqual(own["state_digest"], digests[0])
        self.assert_refused(2, ["generalized_alpha:2", "from 0 to 1"], *run, "generalized_alpha:2")
        wrong = self.scene_of("plate_paper", integrator="generalized_alpha:x")
        self.assert_refused(2, ["/run/integrator", "from 0 to 1"], "run", wrong)

    def scene_of(self, name, **run):
        """A copy of a shipped scene with other values of its "run"."""
        scene = shipped_scene(name)
        scene["run"] |= run
        return self.write(f"{name}.json", json.dumps(scene))

    def test_what_it_does_not_compute_is_refused_in_a_line_that_says_what_would_do(self):
        newmark = (*PLATE, "--integrator", "newmark", "--model", "membrane")
        self.assert_refused(2, ["rk4", "implicit methods alone", "--integrator newmark"], *PLATE,
                            "--model", "membrane")
        self.assert_refused(2, ["f32", "f64 alone"], *newmark,
                            "--precision", "f32")
        self.assert_refused(2, ["--checkpoint", "sparse"], *newmark,
                            "--checkpoint", self.path("c"))
        self.assert_refused(2, ["--rtol", "newmark"], *newmark, "--rtol",
                            "1e-6")

    def test_other_variants_do_not_take_it_for_a_part(self):
        self.assert_refused(2, ["newmark", "variant mpi has the explicit methods alone", "sparse"],
                            *PLATE, "--integrator", "newmark", "--ranks", "2")
        self.assert_refused(2, ["sparse"], "run", "plate_paper", "--set", "n=10", "--steps", "4",
                            "--hybrid", "sparse,scalar")


if __name__ == "__main__":
    unittest.main()
