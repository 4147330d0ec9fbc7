cdef double transverse_height(double h, Model p) noexcept nogil
cdef void body_acceleration(double* y, double* u, Model p, double* w, double sin_p, double cos_p) noexcept nogil
cdef (double, double) leg_derivatives(double* y, Model p, double* w, double* dy, int i, double ax, double ay, double pitch_acc) noexcept nogil
cdef void right_hand_side(double* y, double* u, Model p, double* dy, double* w) noexcept nogil
