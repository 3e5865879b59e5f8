/* `failed`: [0] is the first step that left a number that is not finite; then for each block its
 * own first step and the row. Later passes do nothing, so the host finds the state of the failing
 * step. */

/* Whether an own element of the row is not finite. Halo elements do not count: the outermost lack
 * links. */
static bool has_failed(device d, global const row_stage* task) {
  bool is_failed = false;
  for EACH_PACK(task) {
    const uint mask = d.masks[task->masks + pack].own;
    global const NUMBER* p = d.arena + task->out + (long)pack * (task->fields * W) + LANE;
    REAL sum = SPLAT(0);
    for (int f = 0; f < task->state_fields; ++f, p += W) sum = FMA(LOAD(p), SPLAT(0), sum);
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
