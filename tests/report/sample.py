"""A tiny directory of results with what the committed ones may not have: tables of kernels, of old and resumed records, a broken and an outdated table. Its figures are
invented, and it lives for one test."""
import csv
import datetime
import json
import pathlib

NEW, OLD = "1" * 40, "0" * 40
START = datetime.datetime(2030, 1, 2, 12, 0, tzinfo=datetime.timezone.utc)


def write_table(directory, name, columns, rows):
    path = pathlib.Path(directory) / "tables" / f"{name}.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns.split(","))
        writer.writerows(rows)


def write_record(directory, name, commit, times):
    """raw/NAME.json and raw/NAME.csv of repetitions at these times."""
    raw = pathlib.Path(directory) / "raw"
    raw.mkdir(parents=True, exist_ok=True)
    context = {"git_commit": commit, "git_dirty": False, "date": f"{times[0]:%Y-%m-%dT%H:%M:%SZ}", "cpu_model": "A <processor>", "num_cpus": 2, "compiler": "GNU 12"}
    (raw / f"{name}.json").write_text(json.dumps({"context": context, "experiment": name, "title": name, "scale": "host", "scenes": {}}), encoding="utf-8")
    lines = ["cell,process_s,time_utc", *[f"a,1.5,{time:%Y-%m-%dT%H:%M:%SZ}" for time in times]]
    (raw / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def times(start, count):
    return [start + datetime.timedelta(seconds=2 * place) for place in range(count)]


HOST = """source,label,scene,set,variant,threads,ranks,model,precision,integrator,steps,repetitions,contaminated,measured_wall_s,measured_wall_low_s,measured_wall_high_s,extrapolated_wall_s,extrapolated_to_steps,
speedup_vs_reference,extrapolated_speedup_vs_reference,speedup_vs_scalar,resolution,check,status,paper_wall_s,paper_speedup,paper_source""".replace("\n", "")
KERNELS = """cell,kernel,model,precision,variant,level,working_set_bytes,threads,flops_per_element,bytes_per_element,repetitions,measured_ns_per_element,measured_ns_per_element_low,measured_ns_per_element_high,
elements_per_s,flops_per_s,bytes_per_s,intensity_flop_per_byte,roof_flops_per_s,share_of_roof,limiter,cycles_per_element,check,status,reason""".replace("\n", "")
CEILINGS = "kind,benchmark,isa,precision,level,working_set_bytes,threads,measured_per_s,tool,command,status,reason"
ATTRIBUTION = "variant,model,precision,scene,n,threads,part,count_per_step,measured_ns_per_element_step,share_of_step,share_of_ceiling,mix_bound_ns,limiter,sum_over_step"
CHAIN = """link,label,scene,set,variant,threads,model,precision,integrator,dt_s,end_time_s,steps,measured_wall_s,measured_wall_low_s,measured_wall_high_s,factor_of_link,factor_vs_reference,
factor_vs_reference_low,factor_vs_reference_high,error_max,error_bar,check,status,reason""".replace("\n", "")
FAILURES = "experiment,case,scene,set,method,precision,rotation,model,variant,dt_s,steps,metric,figure,predicted,deviation,verdict,expected,why,status,reason"


def write_kernels(directory):
    """A part of a row, a row and a step on three variants, under their ceilings."""
    speeds, rows, ceilings = {"scalar": 4e9, "avx2": 2e10, "avx512": 4e10}, [], []
    for variant, speed in speeds.items():
        for precision, width in (("f64", 1), ("f32", 2)):
            ceilings.append(["flops", f"peakflops_{variant}", variant, precision, "", 32768, 1, speed * width * 1.3, "likwid-bench", "", "ok", ""])
            for kernel, intensity in (("rotation", 3.0), ("stage_row", 4.0), ("rk4_step", 2.5)):
                for level, part in (("L1", 0.9), ("memory", 0.5)):
                    rate = speed * width * part
                    rows.append([f"{kernel} {variant}", kernel, "spatial", precision, variant, level, 30000, 1, 400, 100, 9, 400e9 / rate, "", "", rate / 400, rate, rate / intensity, intensity, speed * width * 1.3,
                                 part / 1.3, "mix of instructions", "", "passed", "ok", ""])
    for level, speed in (("L1", 2e11), ("L2", 8e10), ("L3", 3e10), ("memory", 1e10)):
        ceilings.append(["bytes", f"load_{level}", "avx512", "", level, 32768, 1, speed, "likwid-bench", "", "ok", ""])
    write_table(directory, "kernels", KERNELS, rows)
    write_table(directory, "ceilings", CEILINGS, ceilings)
    parts = [[variant, "spatial", "f64", "plate_paper", 100, 1, part, 4, time * factor, time / 100, 0.6, 0.6 * time * factor, "loads <and> stores", 1.03 if part == "step" else ""]
             for variant, factor in (("scalar", 10), ("avx512", 1)) for part, time in (("stage_row", 77), ("stage_row_last", 26), ("rest", -3), ("step", 100))]
    write_table(directory, "attribution", ATTRIBUTION, parts)


def write_sample(directory):
    """Everything of the sample; the studies that it leaves out are missing."""
    host = [["measured", f"{variant}, {threads} thread", "plate_paper", "n=100", variant, threads, 1, "spatial", "f64", "rk4", 1000, 6, 0, wall, "", "", "", "", 8 / wall, "", 2 / wall, 0.02, "passed", "ok", "", "", ""]
            for variant, threads, wall in (("reference", 1, 8), ("scalar", 1, 2), ("avx512", 1, 0.5))]
    write_table(directory, "table1_host", HOST, [*host, ["paper", "1 process, no vectorisation", *[""] * 22, 5254.72, "", "Table 1"]])
    write_kernels(directory)
    labels = ["reference", "scalar", "avx512", "2 threads", "planar", "f32", "too long a step"]
    write_table(directory, "chain", CHAIN, [[place, label, "plate_paper", "n=300", "avx512", 1, "spatial", "f64", "rk4", 1e-6, 2e-3, 2000, 100 / 4**place, "", "", 4 if place else 1, 4**place, 3.9**place, 4.1**place,
                                             1e-7 * 3**place if place < 6 else 1e-3, 8.9e-5, "passed", "ok", ""] for place, label in enumerate(labels)])
    atlas = [["failures", "</script><b>case", "pair", f"zeta={zeta}", method, "f64", "quaternion", "spatial", "avx512", 1e-3, 100, "error", 0.5, "", "", verdict, "ok", "because theory says so", status, "a reason"]
             for zeta, method, verdict, status in ((0, "rk4", "ok", "passed"), (1, "rk4", "unstable", "failed"), (0, "rkc2", "refused", "failed"))]
    write_table(directory, "failures", FAILURES, atlas)
    write_table(directory, "advise", "experiment,scene", [["advise", "plate_paper"]])  # of an earlier version
    write_table(directory, "statics", "experiment,scene", [])  # no rows
    write_record(directory, "table1_host", NEW, times(START, 5))
    write_record(directory, "kernels", OLD, times(START - datetime.timedelta(days=3), 5))
    write_record(directory, "failures", NEW, times(START - datetime.timedelta(days=1), 4))
    # Cut off after four repetitions, resumed an hour later.
    write_record(directory, "chain", NEW, times(START - datetime.timedelta(hours=1), 4) + times(START + datetime.timedelta(minutes=1), 3))
