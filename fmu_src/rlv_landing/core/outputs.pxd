cdef double FALLING, CONTACT, SETTLED, TOPPLED, TURNED_OVER, REST_SPEED, REST_ACCELERATION
cdef int BODY_OUTPUTS, ENERGY_OUTPUTS, STATUS_OUTPUTS, LEG_OUTPUTS
cdef double stability_margin(double x, Model p, double[::1] w) noexcept nogil
cdef double phase(double[::1] y, double[::1] dy, Model p, double[::1] w, double margin) noexcept nogil
cdef void leg_outputs(double[::1] y, Model p, double[::1] w, int i, double[::1] out, int o) noexcept nogil
cdef void outputs(double[::1] y, double[::1] u, Model p, double[::1] dy, double[::1] w, double E0, double[::1] out) noexcept nogil
