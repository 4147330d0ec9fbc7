cdef double transverse_height(double h, Model p) noexcept nogil
cdef void body_acceleration(double[::1] y, double[::1] u, Model p, double[::1] w, double sin_p, double cos_p) noexcept nogil
cdef (double, double) leg_derivatives(double[::1] y, Model p, double[::1] w, double[::1] dy, int i, double ax, double ay, double pitch_acc) noexcept nogil
cdef void right_hand_side(double[::1] y, double[::1] u, Model p, double[::1] dy, double[::1] w) noexcept nogil
