cdef double FALLING, CONTACT, SETTLED, TOPPLED, TURNED_OVER, REST_SPEED, REST_ACCELERATION
cdef int BODY_OUTPUTS, ENERGY_OUTPUTS, STATUS_OUTPUTS, LEG_OUTPUTS
cdef double vehicle_x(double* y, Model p, double* w) noexcept nogil
cdef double stability_margin(double* y, Model p, double* w) noexcept nogil
cdef double phase(double* y, double* dy, Model p, double* w, double margin) noexcept nogil
cdef void leg_outputs(double* y, Model p, double* w, int i, double* out, int o) noexcept nogil
cdef void outputs(double* y, double* u, Model p, double* dy, double* w, double E0, double* out, int o) noexcept nogil
