"""No output replaces a file that the command reads, or another output."""
import json
import os
import pathlib
import shutil
import unittest

from program import ProgramTest, dssbench

SCENES = pathlib.Path(__file__).resolve().parents[2] / "experiments" / "scenes"


class Files(ProgramTest):
    def setUp(self):
        super().setUp()
        self.scene = self.path("own.json")
        shutil.copy(SCENES / "two_bodies.json", self.scene)

    def assert_nothing_written(self, words, *arguments):
        before = {name: self.read(name) for name in sorted(os.listdir(self.directory))}
        self.assert_refused(2, words, *arguments)
        after = {name: self.read(name) for name in sorted(os.listdir(self.directory))}
        self.assertEqual(before, after)

    def run_own(self, *options):
        return ("run", self.scene, "--steps", "2", *options)

    def test_no_command_writes_over_its_scene(self):
        json = ("--json", self.scene)
        for command in (self.run_own(*json),
                        ("run", self.scene, *json, "--analysis", "static"),
                        self.run_own(*json, "--ensemble", "3"),
                        self.run_own(*json, "--ranks", "2"),
                        ("explain", self.scene, *json),
                        ("stability", self.scene, *json),
                        ("simulate", self.scene, "--ranks", "2", *json),
                        ("advise", self.scene, "--tolerance", "1e-3", *json),
                        ("verify", self.scene, *json),
                        ("decompose", self.scene, "--parts", "2", *json),
                        ("decompose", self.scene, "--parts", "2", "--output", self.scene)):
            self.assert_nothing_written([self.scene, "SCENE reads this file"], *command)

    def test_a_file_is_known_by_any_of_its_names(self):
        os.symlink(self.scene, self.path("link.json"))
        os.link(self.scene, self.path("hard.json"))
        detour = os.path.join(self.directory, "..", os.path.basename(self.directory), "own.json")
        for other in (self.path("link.json"), self.path("hard.json"), detour):
            self.assert_nothing_written(["SCENE reads this file"], *self.run_own("--json", other))

    def test_no_output_replaces_the_voxels_of_a_scene(self):
        with open(SCENES / "l_bracket.json", encoding="utf-8") as file:
            scene = json.load(file)
        voxels = self.write("body.txt", "###\n###\n")
        scene["bodies"][0]["geometry"] = {"voxels": {"file": "body.txt"}}
        path = self.write("voxels.json", json.dumps(scene))
        for command in (("run", path, "--json", voxels), ("run", path, "--state", voxels),
                        ("explain", path, "--json", voxels), ("verify", path, "--json", voxels),
                        ("decompose", path, "--parts", "2", "--output", voxels)):
            self.assert_nothing_written([voxels, "SCENE reads this file"], *command)
        other = self.write("other.txt", "##\n##\n")
        changed = ("--set", "bodies/0/geometry/voxels/file=other.txt")
        for command in ("run", "explain", "stability"):
            self.assert_nothing_written([other, "SCENE reads this file"], command, path, *changed,
                                        "--json", other)
        members = self.write("m.json", json.dumps({"members": [
            {}, {"set": {"bodies/0/geometry/voxels/file": "other.txt"}}]}))
        self.assert_nothing_written([other, "SCENE reads this file"], "run", path, "--ensemble",
                                    members, "--json", other)

    def test_no_output_replaces_the_platform_of_a_simulation(self):
        platform = self.path("own.xml")
        shutil.copy(SCENES.parent / "platforms" / "ten_gigabit.xml", platform)
        self.assert_nothing_written(["--platform reads this file"], "simulate", self.scene,
                                    "--ranks", "2", "--platform", platform, "--json", platform)

    def test_no_output_replaces_another(self):
        one = self.path("one")
        self.assert_nothing_written(["--state", "--json writes this file"],
                                    *self.run_own("--state", one, "--json", one))
        self.assert_nothing_written(["--output", "--state writes this file"],
                                    *self.run_own("--state", one, "--output", one))
        self.assert_nothing_written(
            ["--json", "--output writes this file"], "decompose", self.scene, "--parts", "2",
            "--output", one, "--json", one)

    def test_no_output_is_a_file_of_a_series(self):
        series = ("--output", self.path("f.vtu"), "--frames", "2")
        for other in ("f_0001.vtu", "f.pvd"):
            self.assert_nothing_written(["--output", "--state writes", other],
                                        *self.run_own(*series, "--state", self.path(other)))
        for other in ("f.vtu", "f_a.vtu", "g_0001.vtu"):
            result = dssbench(*self.run_own(*series, "--state", self.path(other)))
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_no_output_is_a_file_of_a_member(self):
        members = self.write("members.csv", "name,run/dt\nlight,1e-7\n")
        ensemble = ("--ensemble", members, "--state", self.path("end.csv"))
        self.assert_nothing_written(
            ["--state writes one of these files"],
            *self.run_own(*ensemble, "--output", self.path("end.csv")))
        self.assert_nothing_written(["--json writes one of these files"],
                                    *self.run_own(*ensemble, "--json", self.path("end-light.csv")))
        self.assert_nothing_written(["--ensemble reads this file"],
                                    *self.run_own(*ensemble, "--json", members))

    def test_no_output_replaces_another_input(self):
        parts = self.path("parts.json")
        self.assertEqual(dssbench("decompose", self.scene, "--parts", "2", "--output",
                                  parts).returncode, 0)
        self.assert_nothing_written(
            ["--decomposition reads this file"],
            *self.run_own("--ranks", "2", "--decomposition", parts, "--json", parts))
        self.assert_nothing_written(["--from reads this file"], "decompose", self.scene, "--from",
                                    parts, "--json", parts)
        for option in ("--reference", "--check-state"):
            self.assert_nothing_written([f"{option} reads this file"],
                                        *self.run_own(option, parts, "--state", parts))

    def test_devices_may_be_written_twice(self):
        result = dssbench(*self.run_own("--state", "/dev/null", "--json", "/dev/null"))
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_a_target_that_cannot_be_written_is_refused_before_computing(self):
        target = os.path.join(self.directory, "no", "such.json")
        for command in (("explain", self.scene), ("stability", self.scene),
                        ("simulate", self.scene, "--ranks", "2"),
                        ("advise", self.scene, "--tolerance", "1e-3"), ("verify", self.scene)):
            self.assert_refused(2, [target], *command, "--json", target)


if __name__ == "__main__":
    unittest.main()
