"""dssbench as an application of Ramble (and so of Benchpark): scenes by variant, threads, ranks."""
from ramble.appkit import (ExecutableApplication, executable, figure_of_merit, success_criteria,
                           workload, workload_variable)

NUMBER = r"[-+.e\d]+"


class Dssbench(ExecutableApplication):
    """Dynamic stress and strain of bodies of elements: rate, energy and digest of the state.

    Runs with the same scene, steps, model, precision and method have the same digest on every
    variant with fused multiply-adds, on any number of threads and ranks.
    """
    name = "dssbench"

    executable("run", "dssbench run {scene} {overrides} --steps {steps} --variant {variant} "
               "--threads {n_threads} --model {model} --precision {precision} "
               "--integrator {method}", use_mpi=True)
    workload("scene", executables=["run"])

    for variable, default, meaning in (
            ("scene", "plate_paper", "a name of `dssbench list scenes`, or a path"),
            ("overrides", "--set n=100", "values that replace those of the scene"),
            ("steps", "1000", "number of steps"),
            ("variant", "auto", "a name of `dssbench list variants`"),
            ("model", "auto", "model, such as spatial or planar"),
            ("precision", "f64", "f64, f32 or f32c"),
            ("method", "rk4", "a name of `dssbench list methods`")):
        workload_variable(variable, default=default, description=meaning, workloads=["scene"])

    figure_of_merit("rate", units="million element-steps/s", group_name="rate",
                    fom_regex=rf"wall {NUMBER} s, (?P<rate>{NUMBER}) million element-steps/s")
    figure_of_merit("wall time", units="s", group_name="wall",
                    fom_regex=rf"wall (?P<wall>{NUMBER}) s, ")
    figure_of_merit("state", units="", group_name="state",
                    fom_regex=r".* J, state (?P<state>[0-9a-f]+)")
    success_criteria("the run has a state", mode="string", match=r".*, state [0-9a-f]+.*")
