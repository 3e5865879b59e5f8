"""A small directory of results with invented values, for tests.

It has what the committed results may lack: tables of kernels, old and resumed records, an empty
table, and a table of another version.
"""
import csv
import datetime
import json
import pathlib

NEW, OLD = "1" * 40, "0" * 40
START = datetime.datetime(2030, 1, 2, 12, 0, tzinfo=datetime.timezone.utc)

HOST = """source,label,scene,set,variant,threads,ranks,model,precision,integrator,steps,
    repetitions,contaminated,measured_wall_s,measured_wall_low_s,measured_wall_high_s,
    extrapolated_wall_s,extrapolated_to_steps,speedup_vs_reference,
    extrapolated_speedup_vs_reference,speedup_vs_scalar,resolution,check,status,paper_wall_s,
    paper_speedup,paper_source"""
KERNELS = """cell,kernel,model,precision,variant,level,working_set_bytes,threads,flops_per_element,
    bytes_per_element,repetitions,measured_ns_per_element,measured_ns_per_element_low,
    measured_ns_per_element_high,elements_per_s,flops_per_s,bytes_per_s,intensity_flop_per_byte,
    roof_flops_per_s,share_of_roof,limiter,cycles_per_element,check,status,reason"""
CEILINGS = """kind,benchmark,isa,precision,level,working_set_bytes,threads,measured_per_s,tool,
    command,status,reason"""
ATTRIBUTION = """variant,model,precision,scene,n,threads,part,count_per_step,
    measured_ns_per_element_step,share_of_step,share_of_ceiling,mix_bound_ns,limiter,
    sum_over_step"""
CHAIN = """stage,role,label,scene,set,variant,threads,model,precision,integrator,dt_s,end_time_s,
    steps,wall_s,wall_low_s,wall_high_s,base,factor_of_stage,factor_vs_base,factor_vs_base_low,
    factor_vs_base_high,error_max,error_bar,check,status,reason"""
PAPER = """experiment,scale,row,column,way,base,unit,paper,measured,measured_low,measured_high,ran,
    machine,set,steps,scaled,repetitions,contaminated,simulated_paper_node,simulated_own_node,
    status"""
FAILURES = """experiment,case,scene,set,method,precision,rotation,model,variant,dt_s,steps,metric,
    figure,predicted,deviation,verdict,expected,why,status,reason"""


def write_table(directory, name, columns, rows):
    """Writes tables/NAME.csv. columns: names with commas; rows: lists of values, or dictionaries"""
    names = ["".join(column.split()) for column in columns.split(",")]
    path = pathlib.Path(directory) / "tables" / f"{name}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow(row if isinstance(row, dict) else dict(zip(names, row, strict=True)))


def write_record(directory, name, commit, times):
    """Writes raw/NAME.json and raw/NAME.csv of repetitions at these times."""
    raw = pathlib.Path(directory) / "raw"
    raw.mkdir(parents=True, exist_ok=True)
    context = {"git_commit": commit, "git_dirty": False, "date": f"{times[0]:%Y-%m-%dT%H:%M:%SZ}",
               "cpu_model": "A <processor>", "num_cpus": 2, "compiler": "GNU 12"}
    record = {"context": context, "experiment": name, "title": name, "scale": "host", "scenes": {}}
    (raw / f"{name}.json").write_text(json.dumps(record), encoding="utf-8")
    lines = ["cell,process_s,time_utc", *[f"a,1.5,{time:%Y-%m-%dT%H:%M:%SZ}" for time in times]]
    (raw / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def times(start, count):
    """Times at a distance of two seconds."""
    return [start + datetime.timedelta(seconds=2 * place) for place in range(count)]


def write_host(directory):
    """Table 1, and Table 1 on one process: three measured cells and a published one."""
    common = {"scene": "plate_paper", "set": "n=100", "ranks": 1, "model": "spatial",
              "precision": "f64", "integrator": "rk4", "steps": 1000, "repetitions": 6,
              "contaminated": 0, "resolution": 0.02, "check": "passed", "status": "ok"}
    rows = [{**common, "source": "measured", "label": f"{variant}, 1 thread", "variant": variant,
             "threads": 1, "measured_wall_s": wall_s, "speedup_vs_reference": 8 / wall_s,
             "speedup_vs_scalar": 2 / wall_s}
            for variant, wall_s in (("reference", 8), ("scalar", 2), ("avx512", 0.5))]
    rows.append({"source": "paper", "label": "1 process, no vectorisation",
                 "paper_wall_s": 5254.72, "paper_source": "Table 1"})
    for table in ("table1", "table1_host"):
        write_table(directory, table, HOST, rows)


def write_paper(directory):
    """Table 1 of the paper: a base, and two processes in two ways."""
    common = {"experiment": "paper_table1", "scale": "host", "row": "CPU + FMA",
              "machine": "A <processor>, 2 cores", "set": "n=300", "steps": 100, "scaled": "yes",
              "repetitions": 6, "contaminated": 0, "status": "ok"}
    rows = [{**common, "column": "T1", "way": "the base", "base": "as_published", "unit": "s",
             "paper": 5254.72, "measured": 1000, "measured_low": 990, "measured_high": 1010,
             "ran": "as_published, 1 thread"}]
    for way, time_s in (("as the paper did", 50), ("our best", 10)):
        rows.append({**common, "column": "T2", "way": way, "unit": "s", "paper": 370.71,
                     "measured": time_s, "measured_low": 0.9 * time_s,
                     "measured_high": 1.1 * time_s, "ran": "avx2, 2 ranks x 1 thread",
                     "simulated_paper_node": 380, "simulated_own_node": 4})
        rows.append({**common, "column": "T1/T2", "way": way, "base": "as_published",
                     "unit": "ratio", "paper": 14.17, "measured": 1000 / time_s,
                     "measured_low": 900 / time_s, "measured_high": 1100 / time_s,
                     "ran": "avx2, 2 ranks x 1 thread", "simulated_paper_node": 13.8})
    rows.append({**common, "column": "T4", "way": "our best", "unit": "s", "paper": 269.2,
                 "status": "oversubscribed"})
    write_table(directory, "paper_table1", PAPER, rows)


def write_kernels(directory):
    """A part of a row, a row and a step on three variants, under their ceilings."""
    rows, ceilings = [], []
    for variant, speed in (("scalar", 4e9), ("avx2", 2e10), ("avx512", 4e10)):
        for precision, width in (("f64", 1), ("f32", 2)):
            peak = speed * width * 1.3
            ceilings.append({"kind": "flops", "benchmark": f"peakflops_{variant}", "isa": variant,
                             "precision": precision, "working_set_bytes": 32768, "threads": 1,
                             "measured_per_s": peak, "tool": "likwid-bench", "status": "ok"})
            for kernel, intensity in (("rotation", 3.0), ("stage_row", 4.0), ("rk4_step", 2.5)):
                for level, part in (("L1", 0.9), ("memory", 0.5)):
                    rate = speed * width * part
                    rows.append([f"{kernel} {variant}", kernel, "spatial", precision, variant,
                                 level, 30000, 1, 400, 100, 9, 400e9 / rate, "", "", rate / 400,
                                 rate, rate / intensity, intensity, peak, part / 1.3,
                                 "mix of instructions", "", "passed", "ok", ""])
    ceilings += [{"kind": "bytes", "benchmark": f"load_{level}", "isa": "avx512", "level": level,
                  "working_set_bytes": 32768, "threads": 1, "measured_per_s": speed,
                  "tool": "likwid-bench", "status": "ok"}
                 for level, speed in (("L1", 2e11), ("L2", 8e10), ("L3", 3e10), ("memory", 1e10))]
    write_table(directory, "kernels", KERNELS, rows)
    write_table(directory, "ceilings", CEILINGS, ceilings)


def write_attribution(directory):
    """The time of a step by part on two variants; the rest is below zero."""
    parts = {"stage_row": 77, "stage_row_last": 26, "rest": -3, "step": 100}
    rows = [[variant, "spatial", "f64", "plate_paper", 100, 1, part, 4, time * factor, time / 100,
             0.6, 0.6 * time * factor, "loads <and> stores", 1.03 if part == "step" else ""]
            for variant, factor in (("scalar", 10), ("avx512", 1)) for part, time in parts.items()]
    write_table(directory, "attribution", ATTRIBUTION, rows)


def write_chain(directory):
    """A chain whose last stage is the fastest, and exceeds the allowed error."""
    labels = ["reference", "scalar", "avx512", "2 threads", "planar", "f32", "too long a step"]
    rows = [[stage, "stage", label, "plate_paper", "n=300", "avx512", 1, "spatial", "f64", "rk4",
             1e-6, 2e-3, 2000, 100 / 4**stage, "", "", "as_published", 4 if stage else 1, 4**stage,
             3.9**stage, 4.1**stage, 1e-7 * 3**stage if stage < 6 else 1e-3, 8.9e-5, "passed",
             "ok", ""]
            for stage, label in enumerate(labels)]
    write_table(directory, "chain", CHAIN, rows)


def write_failures(directory):
    """Three cells of the failure atlas; two differ from theory."""
    rows = [["failures", "</script><b>case", "pair", f"zeta={zeta}", method, "f64", "quaternion",
             "spatial", "avx512", 1e-3, 100, "error", 0.5, "", "", verdict, "ok",
             "because theory says so", status, "a reason"]
            for zeta, method, verdict, status in (
                (0, "rk4", "ok", "passed"), (1, "rk4", "unstable", "failed"),
                (0, "rkc2", "refused", "failed"))]
    write_table(directory, "failures", FAILURES, rows)


def write_sample(directory):
    """Writes the whole sample; it lacks the tables of other studies."""
    write_host(directory)
    write_paper(directory)
    write_kernels(directory)
    write_attribution(directory)
    write_chain(directory)
    write_failures(directory)
    # A table of another version, and one without rows.
    write_table(directory, "advise", "experiment,scene", [["advise", "plate_paper"]])
    write_table(directory, "statics", "experiment,scene", [])
    for study in ("table1", "paper_table1", "table1_host"):
        write_record(directory, study, NEW, times(START, 5))
    write_record(directory, "kernels", OLD, times(START - datetime.timedelta(days=3), 5))
    write_record(directory, "failures", NEW, times(START - datetime.timedelta(days=1), 4))
    # Cut off after four repetitions, resumed an hour later.
    before = times(START - datetime.timedelta(hours=1), 4)
    write_record(directory, "chain", NEW, before + times(START + datetime.timedelta(minutes=1), 3))
