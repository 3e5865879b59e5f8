/* A tried step (variants/engine/step_error.hpp). `lists` has the rows of its last stage. Their
 * input is the result of the step, their base is the state, and their output is the estimated
 * error. */
#define IS_OF_STATE(task) ((task)->action == error_stage || (task)->action == kept_error)
#define KINDS 4
/* Maxima of the errors of u, v, q and w, then of the states, then 1 if a number is not finite. */
#define MAXIMA (2 * KINDS + 1)

/* Adds the lanes of one work-item. Works on numbers, whatever a REAL is. */
static void add_maxima(device d, global const row_stage* task, const int first, const int stride,
                       NUMBER* most) {
  for (int at = first; at < task->packs * W; at += stride) {
    const int pack = at / W, lane = at % W;
    if (!(d.masks[task->masks + pack].own >> lane & 1)) continue;
    const long place = (long)pack * (task->fields * W) + lane;
    for (int f = 0; f < FIELDS; ++f) {
      const int kind = f < VEC_SIZE ? 0 : f < 2 * VEC_SIZE ? 1 : f < FIELDS - SPIN_SIZE ? 2 : 3;
      const NUMBER e = fabs(d.arena[task->out + place + f * W]),
                   y = fabs(d.arena[task->in + place + f * W]);
      most[kind] = most[kind] < e ? e : most[kind];
      most[KINDS + kind] = most[KINDS + kind] < y ? y : most[KINDS + kind];
      if (!(isfinite(e) && isfinite(y))) most[2 * KINDS] = 1;
    }
  }
}

/* @param maxima  MAXIMA numbers for each band
 * @param items   room for MAXIMA numbers of each work-item of a group */
kernel void step_maxima(TABLES, global const int2* lists, global NUMBER* maxima,
                        local NUMBER* items) {
  const device d = DEVICE;
  const int2 list = lists[BLOCK];
  const int item = get_local_id(0), count = get_local_size(0);
  NUMBER most[MAXIMA];
  for (int k = 0; k < MAXIMA; ++k) most[k] = 0;
  for (int n = list.x; n < list.y; ++n)
    if (IS_OF_STATE(tasks + n)) add_maxima(d, tasks + n, item, count, most);
  for (int k = 0; k < MAXIMA; ++k) items[item * MAXIMA + k] = most[k];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int k = item; k < MAXIMA; k += count) {
    NUMBER largest = 0;
    for (int other = 0; other < count; ++other) {
      const NUMBER one = items[other * MAXIMA + k];
      largest = largest < one ? one : largest;
    }
    maxima[BLOCK * MAXIMA + k] = largest;
  }
}

/* Makes the result of the tried step the state. In compensated precision increments follow its
 * fields; the low parts are computed as in kept_step. */
kernel void accept_rows(TABLES, global const int2* lists) {
  const device d = DEVICE;
  const int2 list = lists[BLOCK];
  for (int n = list.x; n < list.y; ++n) {
    global const row_stage* task = tasks + n;
    if (!IS_OF_STATE(task)) continue;
    for EACH_PACK(task) {
      global NUMBER* state = d.arena + task->base + (long)pack * (task->fields * W) + LANE;
      global const NUMBER* next = d.arena + task->in + (long)pack * (task->fields * W) + LANE;
      for (int f = 0; f < FIELDS; ++f, state += W, next += W) {
        const REAL sum = LOAD(next);
        if (task->action == kept_error) {
          const REAL y = LOAD(state), s = LOAD(state + task->low) + LOAD(next + task->low);
          STORE(lost_of_sum(y, s, sum), state + task->low);
        }
        STORE(sum, state);
      }
    }
  }
}
