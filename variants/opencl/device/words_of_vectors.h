/* Words of CPU devices: a REAL is a pack of W numbers, a work-group is one work-item with a block of rows. From the host: NUMBER,
 * W, REAL, BITS (an integer vector as wide as REAL), and the SHIFTs of this width. */
#define LOAD(p) (*(global const REAL*)(p))
#define STORE(v, p) (*(global REAL*)(p) = (v))
#define IS_ZERO(v) all((v) == SPLAT(0))
#define KEEP(c) c = select(SPLAT(0), c, ((BITS)(mask)&LANE_BITS) != (BITS)(0));
#define LANE 0
#define FIRST_PACK(task) 0
#define PACKS_AT_ONCE 1
#define BLOCK get_global_id(0)
#define SYNCHRONISE
#define STOP_AT(n) count = n;
#define IS_FIRST_ITEM true
#define RECORD_ROW                                                                                                     \
  if (step < failed[1 + 2 * block]) failed[2 + 2 * block] = row; /* the first of the earliest step */
