/* Ends what an algebra has defined, so that the next model can be included. */
#undef AXES
#undef PLANAR
#undef LINEAR
#undef STRESS
#undef HAS_FRAME
