"""What is run smaller, what is not run, and why. An entry that fits no command fails the test."""
from plan import Lists

LEFT_OUT = (  # (pattern of the command as shown, why it is not run)
    (r"^srun |^salloc ", "needs a cluster with Slurm"),
    (r"^\.ci/(run|long)$", "builds for minutes"),
    (r"^cp -r PREFIX|^cmake -B build |^PREFIX/bin", "compiles a variant; the test `install` does"),
    (r"^likwid-perfctr ", "needs hardware counters"),
    (r"^pip install ", "changes the reader's Python; `make wheel` does it in a new environment"),
    (r"^git worktree ", "would change the repository"),
)

# Replacements: (pattern, replacement, why), in this order. The variables $SOURCE, $BUILD (the build
# that is tested) are set.
VALUES = (
    (r"decompose SCENE", "decompose plate_paper", "a scene of several rows"),
    (r"\bSCENE\b(?! \[)", "cantilever_beam", "a scene"),
    (r"--parts P\b", "--parts 2", "a number"),
    (r"--tolerance T\b", "--tolerance 1e-2", "a number"),
    (r"--variant NAME\b", "--variant scalar", "a variant"),
    (r"--variant-path build/variants", "--variant-path .", "a folder of the reader's"),
    (r"verify NAME\b", "verify two_elements", "a scene"),
    (r"experiment NAME\b", "experiment continuum", "a study"),
    (r"compare results build/mine", "compare results results", "one result"),
    (r"build/before/results", "results", "one result"),
    (r"\S+/NAME.csv \S+/NAME.csv", "results/raw/table1.csv results/raw/table1.csv", "one table"),
)

ELSEWHERE = (
    (r"^make\b", "make --directory=$SOURCE --dry-run", "builds, or measures for minutes"),
    (r"^ctest( --preset release)?(.*)", r"ctest --test-dir $BUILD --show-only\2 | grep ' #'",
     "tests are run by themselves; these must exist"),
    (r"^cmake --preset (\w+)", r"cmake -S $SOURCE -N --preset \1", "would configure the tree"),
    (r"^cmake --install build/release", "cmake --install $BUILD", "the build under test"),
    (r"^bundle/bin/", "", "the installed program"),
    (r"(?<!\S)(examples/ensemble|experiments/scenes/arm)/", r"$SOURCE/\1/",
     "a file of the source tree"),
    (r"--device gpu", "--device none", "needs a GPU"),
    (r"opencl@gpu", "opencl@cpu", "needs a GPU"),
    (r"^(?=dssbench compare before/)", "dssbench bench --kernel euler --model spatial --out before "
     ">log && cp -r before after && ", "the reader has made both"),
)

STUDIES = (
    (r" --scale (host|gpu)", "", "takes minutes"),
    (r"experiment table3 (.*--out RESULTS)", r"experiment continuum \1", "takes 40 s"),
    (r"(experiment \w+)(?!.*--out)", r"\1 --out out --dry-run", "takes up to a minute"),
    (r"(experiment \w+)(?!.*--scale)", r"\1 --scale smoke", "takes minutes"),
)

SIZES = (
    (r"verify (?=--)", "verify two_elements ", "all scenes take a minute"),
    (r"verify plate_paper two_bodies", "verify two_elements", "takes half a minute"),
    (r"(verify (?!.*--(device|ranks)).*)", r"\1 --device none", "compiles programs for 40 s"),
    (r"--ranks (1,2,3|2,3)", "--ranks 2", "every number of ranks takes a second"),
    (r"--tolerance 0.1 --vary n", "--tolerance 0.5 --vary n --budget 60", "takes seconds"),
    (r"(\bbench .*--variant avx512)", r"\1 --repetitions 1 --min-time 1e-4", "takes seconds"),
    (r"(\bsweep (plate_paper|my_plate.json).*)",
     r"\1 --steps 5 --repetitions 1 --no-picture --budget 1", "takes a minute"),
    (r"\bn=40,80(,160)?\b", "n=6,8", "takes seconds"),
    (r"\bn=300\b", "n=20", "takes seconds"),
    (r"\bn=10\b", "n=6", "takes seconds"),
    (r"--steps (500|1000)\b", "--steps 20", "takes seconds"),
    (r"(run plate_paper)(?!.*--steps)", r"\1 --steps 20", "takes seconds"),
    (r"--frames 20", "--frames 2", "takes seconds"),
    (r"(run arm/arm)(?!.*static)", r"\1 --set layers=3 --steps 20", "takes a minute"),
    (r"(run arm/arm)(?=.*static)", r"\1 --set layers=3", "takes seconds"),
    (r"--set layers=4 ", "", "a larger grid"),
    (r"(verify arm/arm --variant )avx2,avx512", r"\1avx2", "takes half a minute"),
)

TRANSCRIPTS = (  # transcripts that are run smaller; their lines are then not compared
    (r"plate_paper two_bodies --ranks 2,3", "two_elements --ranks 2", "takes half a minute"),
)

OWN_LINES = (  # (pattern of a line in a transcript, why each machine prints its own)
    (r"^(mpi:|hybrid )", "names the instruction set and measured shares"),
    (r"^(advised|the paper's) ", "measured times, and what was the fastest"),
)

PLACEHOLDERS = ("OLD", "NEW", "DT")  # without a value here: what has one is checked by the help

LISTS = Lists(LEFT_OUT, VALUES + ELSEWHERE + STUDIES + SIZES, PLACEHOLDERS, OWN_LINES, TRANSCRIPTS)
