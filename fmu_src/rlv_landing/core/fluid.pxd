cdef double P_FLOOR
cdef (double, double, double) fluid(double P, double x, double n, double B0, double kB, double Pa) noexcept nogil
cdef double strain_energy(double P, double V, double x, double n, double B0, double kB, double Pa) noexcept nogil
