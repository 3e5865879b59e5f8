/* Words of CPU devices: a REAL is a pack of W numbers, and a work-group is one work-item with a
 * block of rows. The host defines NUMBER, W, REAL, BITS (an integer vector as wide as REAL), and
 * the SHIFTs of this width. */
#define LOAD(p) (*(global const REAL*)(p))
#define STORE(v, p) (*(global REAL*)(p) = (v))
/* Registers are few, so results are stored at once. */
#define STORE_EARLY(v, p) STORE(v, p)
#define STORE_LATE(v, p) ((void)0)
/* A fence for the compiler, which would otherwise keep earlier loads and spill them. */
#ifdef __clang__
#define FORGET_LOADS __asm__ volatile("" ::: "memory");
#else
#define FORGET_LOADS mem_fence(CLK_GLOBAL_MEM_FENCE);
#endif
#define IS_ZERO(v) all((v) == SPLAT(0))
#define KEEP(c) c = select(SPLAT(0), c, ((BITS)(mask)&LANE_BITS) != (BITS)(0));
#define ITEM 0
#define LANE 0
#define EACH_PACK(task) (int pack = 0; pack < (task)->packs; ++pack)
#define BLOCK get_global_id(0)
#define RECORD_ROW                                                                                 \
  if (step <= failed[1 + 2 * block]) /* the first row of the earliest step */                      \
    failed[2 + 2 * block] = step < failed[1 + 2 * block] ? row : min(row, failed[2 + 2 * block]);
