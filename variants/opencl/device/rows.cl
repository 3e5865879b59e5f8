/* A kernel over lists of rows. */

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
