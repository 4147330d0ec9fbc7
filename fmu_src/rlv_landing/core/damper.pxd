cdef double orifice_flow(double dP, double density_ratio, Model p) noexcept nogil
cdef double seal_friction(double v, double P1, double P2, Model p) noexcept nogil
cdef (double, double) stop_force(double s, double v, Model p) noexcept nogil
cdef double orifice_slope(double dP, double density_ratio, Model p) noexcept nogil
cdef (double, double, double, double, double, double, double, double) damper(double s, double v, double P1, double P2, Model p) noexcept nogil
