cdef double A21, A31, A32, A41, A42, A43, A51, A52, A53, A54, A61, A62, A63, A64, A65, A71, A73, A74, A75, A76
cdef double E1, E3, E4, E5, E6, E7, D1, D3, D4, D5, D6, D7
cdef class DormandPrince(Solver):
    cdef public double[::1] k5, k6
    cdef void attempt(self, double h) noexcept nogil
    cdef void bend(self, double h) noexcept nogil
