/* The wavefront of CPU devices: a work-item computes a block of rows. Two blocks may find the
 * pressures of a row of a third, and store them in the same place. OpenCL does not define such a
 * race, but both store the same bits. */

static void publish(device d, global const row_stage* task) {
  for EACH_PACK(task) {
    const long place = (long)pack * (task->fields * W) + LANE;
    for (int f = 0; f < task->fields; ++f)
      STORE(LOAD(d.arena + task->out + place + f * W), d.arena + task->published + place + f * W);
  }
}

/* One pass of the wavefront over the rows of a block (variants/engine/wavefront.cpp): the first
 * `count` sweeps of the tasks [list.x, list.y).
 * @param sweeps   of a step
 * @param a_stage  sweeps of a stage */
static void run_tasks(device d, const int2 list, global const NUMBER* signals, global int* failed,
                      const int block, const int first_step, int count, const int sweeps,
                      const int a_stage, const int signal_width) {
  for (int n = list.x; n < list.y; ++n) {
    global const row_stage* task = d.tasks + n;
    const int sweep = task->sweep;
    if (sweep >= count) continue;
    const bool is_finite = run_task(d, task, signals + sweep / a_stage * signal_width);
    if ((sweep + 1) % sweeps != 0) continue;
    if (!is_finite && has_failed(d, task)) {
      record_failure(failed, block, first_step + sweep / sweeps, task->row);
      count = sweep + 1; /* earlier steps may fail too, and lower rows of this one */
    }
    if (task->published >= 0) publish(d, task);
  }
}

/* Whether all blocks whose rows this one reads have done `passes` passes. Looks at most `patience`
 * times. A block that is not computed at the same time cannot get that far; then the host launches
 * again. So nothing depends on how work-groups are scheduled. */
static bool have_come(volatile global int* progress, const int2 blocks, const int passes,
                      const int patience) {
  for (int other = blocks.x; other < blocks.y; ++other) {
    int spins = 0;
    while (progress[other] < passes)
      if (++spins > patience) return false;
    atomic_or(progress + other, 0); /* its published rows are read after this */
  }
  return true;
}

/* Computes passes of each block, from its progress to last_pass. One launch is enough if all
 * blocks are computed at the same time. */
kernel void run_passes(TABLES, global const int2* lists, global const int2* neighbours,
                       global const NUMBER* signals, global int* failed,
                       volatile global int* progress, const int first_parity, const int last_pass,
                       const int steps_a_pass, const int steps, const int sweeps, const int a_stage,
                       const int signal_width, const int patience, const int first_block,
                       const int block_stride) {
  const device d = DEVICE;
  const int block = first_block + BLOCK * block_stride;
  for (int pass = progress[block]; pass < last_pass; ++pass) {
    const int step = pass * steps_a_pass, parity = (first_parity + pass) & 1;
    if (!have_come(progress, neighbours[block], pass, patience) || failed[0] < step) return;
    run_tasks(d, lists[block * 2 + parity], signals + step * (sweeps / a_stage) * signal_width,
              failed, block, step, min(steps_a_pass, steps - step) * sweeps, sweeps, a_stage,
              signal_width);
    mem_fence(CLK_GLOBAL_MEM_FENCE);
    atomic_xchg(progress + block, pass + 1);
  }
}
