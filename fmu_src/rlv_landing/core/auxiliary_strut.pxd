cdef (double, double) auxiliary(double s, double v, Model p) noexcept nogil
