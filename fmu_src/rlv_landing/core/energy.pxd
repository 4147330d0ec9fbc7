cdef double kinetic_energy(double[::1] y, Model p) noexcept nogil
cdef double potential_energy(double[::1] y, Model p) noexcept nogil
cdef double liquid_energy(double[::1] y, Model p, double[::1] w) noexcept nogil
cdef double auxiliary_energy(Model p, double[::1] w) noexcept nogil
cdef double contact_energy(Model p, double[::1] w) noexcept nogil
cdef double stop_energy(Model p, double[::1] w) noexcept nogil
