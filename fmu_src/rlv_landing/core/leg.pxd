cdef (double, double, double, double) strut(double r, double h, double vr, double vh, double joint_r, double joint_h, double length) noexcept nogil
cdef (double, double, double, double, double, double) ground_frame(double x, double y, double z_rate, double vx, double vy, double sin_a, double cos_a, double* u) noexcept nogil
cdef void leg_loads(double* y, int k, double sin_g, double cos_g, double share_x, double sin_p, double cos_p, double sin_a, double cos_a, double* u, Model p, double* w, int j) noexcept nogil
