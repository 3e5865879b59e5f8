/* Constants of a link of the material law (kernels/link_force/link_force.h): members of a struct in
 * C++ and in OpenCL C. CONSTANT: a number, or a number of each lane. */
CONSTANT k_s, k_ns, k_ts, d_s, d_ns, d_ts, k_z, k_xz, k_yz, d_z, d_xz, d_yz;
