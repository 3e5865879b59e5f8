/* Words of GPUs: a REAL is a number, a work-group has a block of rows. From the host: NUMBER, W, REAL. */
#define LOAD(p) (*(p))
#define STORE(v, p) (*(p) = (v))
#define IS_ZERO(v) ((v) == 0)
#define KEEP(c) c = (mask >> LANE & 1) ? c : 0;
#define LANE ((int)get_local_id(0) % W)
#define PACKS_AT_ONCE ((int)get_local_size(0) / W)
#define FIRST_PACK(task)                                                                                               \
  ((((int)get_local_id(0) / W - (task)->first_pack) % PACKS_AT_ONCE + PACKS_AT_ONCE) % PACKS_AT_ONCE)
#define BLOCK get_group_id(0)
#define SYNCHRONISE barrier(CLK_GLOBAL_MEM_FENCE)
#define STOP_AT(n) /* work-items meet at barriers: none stops before the others */
#define IS_FIRST_ITEM (get_local_id(0) == 0)
#define RECORD_ROW atomic_min(failed + 2 + 2 * block, row); /* a launch is one step: the first row of its items */
