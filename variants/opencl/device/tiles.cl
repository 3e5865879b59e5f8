/* Several stages of a tile of elements in one launch (README.md). Groups store what they compute of
 * one another's elements. OpenCL does not define such a race, but all of them store the same bits.
 * The host defines WIDTH, HEIGHT and HALO. */
#define TILE_X (WIDTH - 2 * HALO)
#define TILE_ROWS (HEIGHT - 2 * HALO)

/* @param first   the first task of the first stage; a stage has a task for each row, in their order
 * @param signal  place of the first stage's signals, of which each stage has `signal_width` */
kernel __attribute__((reqd_work_group_size(WIDTH, HEIGHT, 1)))
void run_tiles(TABLES, global const NUMBER* signals, global int* failed, const int first,
               const int rows, const int stages, const int signal, const int signal_width,
               const int step) {
  device d = DEVICE;
  if (failed[0] < step) return;
  const int x = (int)get_local_id(0) - HALO, y = (int)get_local_id(1) - HALO,
            row = (int)get_group_id(1) * TILE_ROWS + y;
  d.item = (int)get_group_id(0) * TILE_X + x;
  const int layer = max(max(max(-x, x - (TILE_X - 1)), max(-y, y - (TILE_ROWS - 1))), 0);
  const int count = d.item < 0 || row < 0 || row >= rows ? 0 : stages - layer;
  for (int stage = 0; stage < stages; ++stage) {
    if (stage < count) {
      const int n = first + stage * rows + row;
      const bool is_finite = run_task(d, tasks + n, signals + signal + stage * signal_width);
      if (!is_finite && has_failed(d, tasks + n)) record_failure(failed, row, step, row);
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
  }
}
