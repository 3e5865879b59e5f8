/* What to do with a row, for one combination of terms. False: the last stage of a step left what is not finite. */
static int NAME(run)(device d, global const row_stage* task, global const NUMBER* signals) {
  switch (task->action) {
  case prime_upper:
    if (task->upper_y >= 0) NAME(prime)(d, task, 1);
#ifndef PLANAR
    if (task->upper_z >= 0) NAME(prime)(d, task, 2);
#endif
    return 1;
  case prime_y:
    NAME(prime)(d, task, 1);
    return 1;
#ifndef PLANAR
  case prime_z:
    NAME(prime)(d, task, 2);
    return 1;
#endif
  default:
    return NAME(run_row)(d, task, signals);
  }
}
