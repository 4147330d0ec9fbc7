cdef double damping_ramp(double d, Model p) noexcept nogil
cdef (double, double) normal_force(double d, double v, Model p) noexcept nogil
cdef (double, double) friction(double d, double Fn, double mu, double v, double s, Model p) noexcept nogil
cdef (double, double, double, double, double, double, double) contact(double d, double v, double vx, double vz, double sx, double sz, double share_x, Model p) noexcept nogil
