"""Completion in a shell offers exactly what the commands accept."""
import json
import os
import re
import shutil
import subprocess
import unittest

from program import PROGRAM, ProgramTest, dssbench


def offered(*words):
    return dssbench("complete", *words).stdout.split()


def study_file(name):
    listed = json.loads(dssbench("list", "experiments", "--json").stdout)
    return next(study["path"] for study in listed if study["experiment"] == name)


def in_bash(line):
    """What bash offers after this line, with the script that the program prints."""
    words = line.split(" ")
    script = f"""PATH="$(dirname {PROGRAM}):$PATH"
eval "$({PROGRAM} completion bash)"
complete -p dssbench >/dev/null
COMP_WORDS=({' '.join(f"'{word}'" for word in words)})
COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1))
compopt() {{ echo "compopt $*"; }}
_dssbench
printf '%s\\n' "${{COMPREPLY[@]}}"
"""
    result = subprocess.run(
        ["bash", "--norc", "-c", script], capture_output=True, text=True, timeout=60
    )
    assert (result.returncode, result.stderr) == (0, ""), result.stderr
    return result.stdout.split("\n")[:-1]


class Completion(ProgramTest):
    def test_bash_completes_commands_options_and_names(self):
        self.assertEqual(in_bash("dssbench ver"), ["verify"])
        self.assertEqual(in_bash("dssbench run plate_paper --varia"),
                         ["--variant", "--variant-path"])
        self.assertEqual(in_bash("dssbench run tumb"), ["tumbling_box"])
        self.assertEqual(in_bash("dssbench run two_elements --model spa"), ["spatial"])
        # bash takes --integrator=velo apart
        self.assertEqual(in_bash("dssbench run two_elements --integrator = velo"),
                         ["velocity_verlet"])
        self.assertEqual(in_bash("dssbench experiment table1_"), ["table1_host"])
        self.assertEqual(in_bash("dssbench verify two_elements --variant scalar,refer"),
                         ["scalar,reference"])
        self.assertEqual(in_bash("dssbench run plate_paper --set "), ["compopt -o nospace", "n="])
        # a number: bash then offers files, as everywhere
        self.assertEqual(in_bash("dssbench run plate_paper --steps "), [""])

    def test_every_command_and_every_option_is_offered(self):
        commands = offered("")
        self.assertEqual(
            commands,
            re.findall(r"^  (\w+) ",
                       dssbench("--help").stdout.split("Subcommands:")[1], re.M))
        for command in commands:
            options = set(
                re.findall(r"^  (?:-\w,)?(--[\w-]+)",
                           dssbench(command, "--help").stdout, re.M))
            self.assertEqual(set(offered(command, "--")), options | {"--version", "--variant-path"},
                             command)

    def test_what_is_offered_is_what_a_wrong_name_is_told(self):
        run, statics = ("run", "two_elements", "--steps", "2"), (
            "run", "two_elements", "--analysis", "static"
        )
        simulate = ("simulate", "two_elements", "--ranks", "2", "--node-speed", "1e6")
        lines = [("run",), ("list",), ("experiment",), ("help",), ("completion",),
                 (*run, "--variant"), (*run, "--model"), (*run, "--precision"),
                 (*run, "--integrator"), (*run, "--rotation"), (*run, "--halo"),
                 (*run, "--decomposition"), (*run, "--shares"), (*run, "--on-bound"),
                 (*run, "--analysis"), (*statics, "--solver"),
                 (*statics, "--solver", "cg", "--preconditioner"),
                 (*statics, "--solver", "relaxation", "--masses"),
                 ("advise", "two_elements", "--tolerance", "1e-3", "--quantity"),
                 ("experiment", "table1_host", "--scale"), ("experiment", "table3", "--scale"),
                 ("decompose", "two_elements", "--parts", "2", "--method"), (*simulate, "--halo"),
                 (*simulate, "--platform"), (*simulate, "--precision")]
        for line in lines:
            refusal = dssbench(*line, "zzz")
            self.assertEqual(refusal.returncode, 2, line)
            self.assertRegex(refusal.stderr, r"known: ", line)
            known = refusal.stderr.split("known: ")[1].split(";")[0].strip().split(", ")
            self.assertEqual(sorted(offered(*line, "")), sorted(known), line)

    def test_every_kind_of_name_in_the_help_is_one_that_can_be_offered_or_free(self):
        free = {"TEXT", "INT", "FLOAT", "BOOLEAN", "DIR", "KEY=VALUE", "UINT"}
        for command in offered(""):
            for option, kind in re.findall(r"^  (?:-\w,)?(--[\w-]+) ([A-Z][A-Z=]+)",
                                           dssbench(command, "--help").stdout, re.M):
                kind = kind if kind == "KEY=VALUE" else kind.split("=")[0]
                if kind not in free:
                    self.assertTrue(offered(command, option, ""), f"{command} {option} {kind}")

    def test_outside_variants_of_the_line_and_faults_in_it_are_no_error(self):
        self.assertEqual(offered("--variant-path", self.directory, "ru"), ["run"])
        self.assertEqual(offered("--variant-path", self.path("none"), "ru"), ["run"])
        self.assertEqual(offered("nothing", "known", ""), [])

    def test_a_directory_of_outside_variants_is_known_however_it_is_typed(self):
        os.mkdir(self.path("m"))
        self.write("m/wider.so", "")
        self.write("m/wider.json", '{"variant": "wider", "isa": "x86-64", "needs": []}')
        home = {**os.environ, "HOME": self.directory}
        for typed in (("--variant-path", self.path("m")), (f"--variant-path={self.path('m')}",),
                      ("--variant-path", "=", self.path("m")), ("--variant-path", "~/m"),
                      ("--variant-path=~/m",), ("--variant-path", "=", "~/m")):
            result = dssbench("complete", *typed, "run", "two_elements", "--variant", "wid",
                              env=home)
            self.assertEqual((result.returncode, result.stdout.split(), result.stderr),
                             (0, ["wider"], ""), typed)

    def test_scales_are_those_of_the_study_on_the_line(self):
        with open(study_file("table3"), encoding="utf-8") as file:
            scales = sorted(json.load(file)["scales"])
        self.assertIn("gpu", scales)
        self.assertEqual(sorted(offered("experiment", "table3", "--scale", "")), scales)
        self.assertEqual(sorted(offered("experiment", study_file("table3"), "--scale", "")), scales)
        self.assertEqual(in_bash("dssbench experiment table3 --scale = g"), ["gpu"])
        self.assertNotIn("gpu", offered("experiment", "table1_host", "--scale", ""))
        self.assertIn("host", offered("experiment", "--scale", ""))

    def test_the_listing_has_every_scene_that_is_offered(self):
        listed = [
            scene["scene"] for scene in json.loads(dssbench("list", "scenes", "--json").stdout)
        ]
        self.assertEqual(offered("run", ""), listed)

    @unittest.skipUnless(shutil.which("zsh"), "zsh is not installed")
    def test_zsh_completes_as_bash_does(self):
        script = f"""PATH="{os.path.dirname(PROGRAM)}:$PATH"; compdef() {{ : }}; \
compadd() {{ shift; print -l -- "$@" }}; _files() {{ print files }}
source =({PROGRAM} completion zsh)
words=(dssbench run plate_paper --varia); CURRENT=4; _dssbench
words=(dssbench run plate_paper --steps ''); CURRENT=5; _dssbench"""
        result = subprocess.run(
            ["zsh", "-f", "-c", script], capture_output=True, text=True, timeout=60
        )
        self.assertEqual((result.stdout.split(), result.stderr),
                         (["--variant", "--variant-path", "files"], ""))

    @unittest.skipUnless(shutil.which("fish"), "fish is not installed")
    def test_fish_completes_as_bash_does(self):
        script = (f"set PATH {os.path.dirname(PROGRAM)} $PATH; {PROGRAM} completion fish | source; "
                  "complete -C 'dssbench run plate_paper --varia'")
        result = subprocess.run(["fish", "--no-config", "-c", script], capture_output=True,
                                text=True, timeout=60, env={**os.environ, "HOME": self.directory})
        self.assertEqual((result.stdout.split(), result.stderr),
                         (["--variant", "--variant-path"], ""))

    def test_scripts_of_other_shells_ask_the_program_too(self):
        for shell in offered("completion", ""):
            self.assertRegex(dssbench("completion", shell).stdout, r"complete .*2>/dev/null", shell)
        self.assert_refused(2, ['did you mean "bash"'], "completion", "bsh")


if __name__ == "__main__":
    unittest.main()
