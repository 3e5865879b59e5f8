/* What to do with a row, for hosts and devices alike. */
enum row_action {
  prime_y, /* its links to the upper rows across y, or z, or both: what a block needs of a row before it */
  prime_z,
  prime_upper,
  bare_rates,     /* devices: out = rates, forces and moments unscaled, for a host that updates */
  plain_stage,    /* Runge-Kutta: out = base + beta f(in) */
  combined_stage, /* and up to three increments */
  wide_stage,     /* and more */
  leapfrog_step,  /* in place; also of symplectic Euler */
  predicted_step, /* the same where forces depend on velocities: half-step velocities behind the fields */
  kept_stage,     /* compensated (f32c): the increment is kept behind the stage's fields */
  kept_step,      /* the last such stage: the sum of the increments, added to the state and its low parts */
  kept_leapfrog,
  kept_predicted,
  error_stage, /* of an adaptive method: out = the sum of increments without the state, an estimate of the step's error */
  kept_error
};
