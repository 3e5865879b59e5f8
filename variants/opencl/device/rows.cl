/* Kernels over lists of rows. `failed`: [0] is the first step that left a number that is not
 * finite; then for each block its own first step and the row. Later passes do nothing, so the host
 * finds the state of the failing step. */

/* Whether an own element of the row is not finite. Halo elements do not count: the outermost lack
 * links. */
static bool has_failed(device d, global const row_stage* task) {
  bool is_failed = false;
  for EACH_PACK(task) {
    const uint mask = d.masks[task->masks + pack].own;
    global const NUMBER* p = d.arena + task->out + (long)pack * (task->fields * W) + LANE;
    REAL sum = SPLAT(0);
    for (int f = 0; f < task->fields; ++f, p += W) sum = FMA(LOAD(p), SPLAT(0), sum);
    KEEP(sum)
    is_failed = is_failed || !IS_ZERO(sum);
  }
  return is_failed;
}

static void record_failure(global int* failed, const int block, const int step, const int row) {
  atomic_min(failed, step);
  RECORD_ROW
  atomic_min(failed + 1 + 2 * block, step);
}

/* Runs lists of rows in their order: a stage of all rows, or their rates.
 * @param lists  for each block its first place in tasks, and the place behind its last */
kernel void run_rows(TABLES, global const int2* lists, global const NUMBER* signals,
                     global int* failed, const int first_signal, const int step) {
  const device d = DEVICE;
  const int2 list = lists[BLOCK];
  if (failed[0] < step) return;
  for (int n = list.x; n < list.y; ++n) {
    const bool is_finite = run_task(d, tasks + n, signals + first_signal);
    if (!is_finite && has_failed(d, tasks + n)) record_failure(failed, BLOCK, step, tasks[n].row);
  }
}
