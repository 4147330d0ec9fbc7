cdef double kinetic_energy(double* y, Model p) noexcept nogil
cdef double potential_energy(double* y, Model p) noexcept nogil
cdef double liquid_energy(double* y, Model p, double* w) noexcept nogil
cdef double auxiliary_energy(Model p, double* w) noexcept nogil
cdef double contact_energy(Model p, double* w) noexcept nogil
cdef double stop_energy(Model p, double* w) noexcept nogil
