cdef double THIRD, SIXTH, SMALL, KINK
cdef double phi1(double z) noexcept nogil
cdef double phi2(double z, double f1) noexcept nogil
cdef double phi3(double z, double f2) noexcept nogil
cdef class Exponential(Solver):
    cdef public double[::1] decay, driven, weights
    cdef void begin(self) noexcept nogil
    cdef void weigh(self, double h) noexcept nogil
    cdef void drive(self, int stage, double* s, double* k) noexcept nogil
    cdef void settle(self, int g, double* s, double growth, double plain) noexcept nogil
    cdef void stage(self, int i, double ahead, double h, double* k, double* k_next) noexcept nogil
    cdef void attempt(self, double h) noexcept nogil
    cdef void finish(self, double h) noexcept nogil
