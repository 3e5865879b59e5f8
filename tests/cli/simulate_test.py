"""Simulated clusters: what SimGrid is given and returns. Skipped without SimGrid."""
import csv
import json
import pathlib
import unittest

from program import ProgramTest, dssbench

NODE = ["--node-speed", "1.211e6"]  # the paper's: 90,000 elements, 10,000 steps in 743.14 s
WITHOUT = "" if dssbench("simulate", "plate_paper", "--set", "n=20", "--ranks", 2, *
                         NODE).returncode == 0 else "no SimGrid in this build"


def simulate(*arguments):
    result = dssbench("simulate", "plate_paper", *arguments, "--json", "-")
    assert result.returncode == 0, result.stderr
    return json.loads(result.stdout)


@unittest.skipIf(WITHOUT, WITHOUT)
class Simulation(ProgramTest):
    def test_one_node_takes_its_own_time(self):
        result = simulate("--set", "n=300", "--ranks", 1, *NODE)
        self.assertAlmostEqual(result["simulated_step_s"], 90000 / 1.211e6, delta=1e-9)
        self.assertEqual(result["messages_per_step"], 0)

    def test_numbers_that_no_machine_has_are_refused(self):
        shipped = pathlib.Path(__file__).parents[2] / "experiments/platforms/ten_gigabit.xml"
        text = shipped.read_text(encoding="utf-8")
        for name, right in (("bw", "1150MBps"), ("lat", "6us"), ("speed", "1Gf")):
            for wrong in ("nan", "-1", "inf", "1e999", "", "MBps"):
                bad = self.write("bad.xml", text.replace(f'{name}="{right}"', f'{name}="{wrong}"'))
                self.assert_refused(2, [name, "bad.xml", "positive number"], "simulate",
                                    "plate_paper", "--set", "n=20", "--ranks", 2, "--platform",
                                    bad)
        comment = self.write("good.xml", text.replace("<platform ", "<!-- lat='nan' --><platform "))
        self.assertEqual(dssbench("simulate", "plate_paper", "--set", "n=20", "--ranks", 2, *NODE,
                                  "--platform", comment).returncode, 0)

    def test_is_the_same_each_time(self):
        line = [
            "--set", "n=60", "--ranks", 5, "--platform", "gigabit", "--halo", "deep-overlap", *NODE
        ]
        self.assertEqual(simulate(*line)["simulated_step_s"], simulate(*line)["simulated_step_s"])

    def test_ping_pong_finds_what_the_platform_states(self):
        for platform, latency_s, bytes_per_s in [("gigabit", 25e-6, 117e6),
                                                 ("ten_gigabit", 12e-6, 1150e6),
                                                 ("fdr", 1.2e-6, 6e9)]:
            result = simulate("--set", "n=20", "--ranks", 2, "--platform", platform, *NODE)
            # the processors' own time comes on top
            self.assertLess(abs(result["latency_s"] - latency_s), 2 * 3.5e-6)
            self.assertLess(abs(1 / result["seconds_a_byte"] / bytes_per_s - 1), 0.05)

    def test_deep_sends_a_quarter_of_the_messages_and_pays_in_computation(self):
        line = ["--set", "n=100", "--ranks", 4, "--platform", "gigabit", *NODE]
        deep, sendrecv = simulate(*line, "--halo", "deep"), simulate(*line, "--halo", "sendrecv")
        self.assertEqual(4 * deep["messages_per_step"], sendrecv["messages_per_step"])
        self.assertEqual(deep["bytes_per_step"], sendrecv["bytes_per_step"])
        self.assertLess(deep["communication_s_per_step"], sendrecv["communication_s_per_step"])

    def test_unlike_nodes_wait_for_the_slowest_unless_parts_follow_their_speeds(self):
        line = ["--set", "n=120", "--ranks", 3, "--platform", "fdr", "--node-speed",
                "2e6,2e6,5e5"]
        equal, by_speed = simulate(*line), simulate(*line, "--shares", "measured")
        self.assertAlmostEqual(equal["ideal_step_s"], 14400 / 4.5e6, delta=1e-12)
        self.assertAlmostEqual(equal["simulated_step_s"], 4800 / 5e5, delta=0.02 * 4800 / 5e5)
        self.assertLess(by_speed["simulated_step_s"], 1.05 * by_speed["ideal_step_s"])
        self.assert_refused(2, ["--node-speed", "2 speeds of 3 nodes"], "simulate", "plate_paper",
                            "--ranks", 3, "--node-speed", "1e6,2e6")
        self.assert_refused(2, ["--shares", "equal, measured"], "simulate", "plate_paper",
                            "--ranks", 3, "--node-speed", "1e6", "--shares", "fair")

    def mixed(self, **changes):
        study = {
            "scene": "plate_paper", "steps": 100,
            "nodes": {"fast": {"wall_s": 1, "elements": 1e6, "steps": 4},
                      "slow": {"wall_s": 1, "elements": 1e6, "steps": 1}},
            "cases": [{"label": "both", "set": {"n": 40}, "platforms": ["fdr"],
                       "mixes": [{"fast": 2, "slow": 1}]}],
            "held": {"set": {"n": 12}, "pairs": 2}, **changes
        }
        return self.write("tiny.json", json.dumps({
            "experiment": "tiny", "title": "t", "mixed_nodes": study, "scales": {"host": {}}}))

    def test_a_study_of_mixed_nodes_says_what_slow_nodes_bring(self):
        result = dssbench("experiment", self.mixed(), "--out", self.path("out"))
        self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
        with open(self.path("out/tables/tiny.csv"), encoding="utf-8") as file:
            equal, by_speed = csv.DictReader(file)
        self.assertEqual((equal["shares"], by_speed["shares"], by_speed["nodes"]),
                         ("equal", "by speed", "2 fast + 1 slow"))
        self.assertAlmostEqual(float(by_speed["ideal_wall_s"]), 100 * 1600 / 9e6, delta=1e-9)
        self.assertLess(float(equal["over_fastest_alone"]), 0.5)
        self.assertGreater(float(by_speed["over_fastest_alone"]), 1)
        self.assertGreater(float(by_speed["efficiency"]), 0.95)
        with open(self.path("out/tables/tiny_held.csv"), encoding="utf-8") as file:
            [held] = csv.DictReader(file)
        # two pairs have no interval, and say nothing of this machine
        self.assertEqual((held["status"], held.get("simulated_over_run_low", "")), ("ok", ""))
        self.assertGreater(float(held["simulated_over_run"]), 0)

    def test_a_wrong_study_of_mixed_nodes_is_refused(self):
        case = {"label": "both", "set": {"n": 40}, "platforms": ["fdr"], "mixes": [{"fast": 1}]}
        for change, words in [({"cases": [{**case, "mixes": [{"quick": 1}]}]}, ["quick", "kind"]),
                              ({"cases": [{**case, "mixes": [{"fast": 0}]}]}, ["out of range"]),
                              ({"cases": [{**case, "platforms": ["ether"]}]}, ["ether"]),
                              ({"nodes": {}}, ["/mixed_nodes/nodes"]),
                              ({"held": {"pairs": 0}}, ["/mixed_nodes/held/pairs"])]:
            self.assert_refused(2, words, "experiment", self.mixed(**change), "--out",
                                self.path("out"))

    def test_auto_takes_the_fastest_trial_and_is_near_the_best(self):
        for platform in ["gigabit", "fdr"]:
            line = ["--set", "n=120", "--ranks", 6, "--platform", platform, "--node-speed", "3e7"]
            times = {
                halo: simulate(*line, "--halo", halo)["simulated_step_s"]
                for halo in ["sendrecv", "overlap", "deep", "deep-overlap"]
            }
            auto = simulate(*line)
            self.assertEqual(auto["halo"], min(auto["tried_step_s"], key=auto["tried_step_s"].get))
            self.assertLess(auto["simulated_step_s"], 1.05 * min(times.values()), times)

    def test_bad_input_is_one_line(self):
        line = ["simulate", "plate_paper", "--set", "n=20", *NODE]
        self.assert_refused(2, ["--platform", "gigabyte", "gigabit"], *line, "--ranks", 2,
                            "--platform", "gigabyte")
        self.assert_refused(2, ["shared", "deep"], *line, "--ranks", 2, "--halo", "shared")
        self.assert_refused(2, ["--halo", "deap"], *line, "--ranks", 2, "--halo", "deap")
        self.assert_refused(2, ["parts"], *line, "--ranks", 21)
        self.assert_refused(2, ["--ranks"], *line, "--ranks", 0)
        broken = self.write("broken.xml", "<platform")
        self.assert_refused(2, ["broken.xml"], *line, "--ranks", 2, "--platform", broken)

    def study(self, scale=None, **changes):
        block = {
            "label": "x", "scene": "plate_paper", "set": {"n": 24}, "ranks": [1, 2],
            "platforms": ["fdr"], "halos": ["deep", "auto"], "steps": 100, "paper_node": {
                "wall_s": 743.14, "elements": 90000, "steps": 10000
            }, "paper_wall_s": {"1": 743.14, "2": 370.71}
        }
        block.update(changes)
        study = {
            "experiment": "tiny", "title": "t", "simulation": [block],
            "scales": {"host": scale or {}}
        }
        return self.write("tiny.json", json.dumps(study))

    def test_a_study_keeps_published_and_simulated_times_apart(self):
        result = dssbench("experiment", self.study(), "--out", self.path("out"))
        # when and by what it was made
        self.assertIn("context", json.loads(self.read("out/raw/tiny.json")))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(self.path("out/tables/tiny_simulated.csv"), encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 4)
        for row in rows:
            self.assertEqual(row["status"], "ok")
            self.assertEqual(row.get("measured_wall_s", ""), "")
            self.assertGreater(float(row["simulated_paper_node_wall_s"]),
                               float(row["simulated_own_node_wall_s"]))
        self.assertAlmostEqual(float(rows[0]["paper_efficiency"]), 1)
        self.assertAlmostEqual(float(rows[-1]["paper_efficiency"]), 743.14 / 370.71 / 2)

    def test_a_wrong_study_is_refused_before_anything_is_simulated(self):
        for change, words in [({"platforms": ["ether"]}, ["/simulation/0/platforms", "ether"]),
                              ({"halos": ["shared"]}, ["halos", "shared"]),
                              ({"ranks": [0]}, ["/simulation/0/ranks"]), ({"steps": 0}, ["steps"]),
                              ({"set": {"m": 3}}, ["m"]),
                              ({"decompositions": ["stripes"]}, ["stripes"]),
                              ({"paper_wall_s": {"2": 1}}, ["1 rank"])]:
            self.assert_refused(2, words, "experiment", self.study(**change), "--out",
                                self.path("out"))
        for scale, words in [({"leave_out": ["y"]}, ["/scales/host/leave_out", '"y"']),
                             ({"leave_out": ["x"]}, ["/scales/host", "nothing"]),
                             ({"most_elements": 5}, ["/scales/host", "nothing"])]:
            self.assert_refused(2, words, "experiment", self.study(scale), "--out",
                                self.path("out"))


if __name__ == "__main__":
    unittest.main()
