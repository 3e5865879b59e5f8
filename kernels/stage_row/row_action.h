/* What to do with a row, for hosts and devices. */
enum row_action {
  /* prime_*: only the links to the upper rows across y, z or both. A block needs them from the row
   * before its first one. */
  prime_y,
  prime_z,
  prime_upper,
  bare_rates,     /* devices: out = unscaled rates, forces and moments; the host updates */
  plain_stage,    /* Runge-Kutta: out = base + beta f */
  combined_stage, /* plus one to three increments */
  wide_stage,     /* plus more than three increments */
  leapfrog_step,  /* in place; symplectic Euler too */
  /* Leapfrog if forces depend on velocities. The half-step velocities follow the fields. */
  predicted_step,
  kept_stage, /* compensated (f32c): the increment follows the stage's fields */
  /* Last compensated stage: the sum of the increments, added to the state and its low parts. */
  kept_step,
  kept_leapfrog,
  kept_predicted,
  /* Adaptive methods: out is the sum of increments without the state, an estimate of the step's
   * error. */
  error_stage,
  kept_error,
  /* Devices: the pressures at the input of a stage; only the strains of the links that prime_*
   * names. */
  find_pressure,
  prime_strain_y,
  prime_strain_z,
  prime_strain_upper
};
