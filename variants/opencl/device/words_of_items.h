/* Words of GPUs: a REAL is a number, and a work-item is an element. `d.item` is its x on the
 * body's grid. The host defines NUMBER, W, REAL. */
#define LOAD(p) (*(p))
#define STORE(v, p) (*(p) = (v))
/* Compilers do not move loads before stores that may have the same address. So all loads of an
 * update come first, then its stores. */
#define STORE_EARLY(v, p) ((void)0)
#define STORE_LATE(v, p) STORE(v, p)
#define IS_ZERO(v) ((v) == 0)
#define KEEP(c) c = (mask >> LANE & 1) ? c : 0;
#define ITEM ((int)get_global_id(0))
#define LANE (d.item % W)
#define PACK(task) (d.item / W - (task)->first_pack)
#define EACH_PACK(task)                                                                            \
  (int pack = max(PACK(task), 0), end = min(PACK(task) + 1, (task)->packs); pack < end; ++pack)
#define BLOCK get_group_id(1)
#define RECORD_ROW                                                                                 \
  atomic_min(failed + 2 + 2 * block, row); /* a launch is one step, so this is the first row */
