cdef double A21, A31, A32, A41, A42, A43, A51, A52, A53, A54, A61, A62, A63, A64, A65, A71, A73, A74, A75, A76
cdef double E1, E3, E4, E5, E6, E7, D1, D3, D4, D5, D6, D7
cdef double SAFETY, SHRINK, GROW, BETA, EXPONENT, FIRST_STEP, LONGEST_STEP, SHORTEST_STEP
cdef class Solver:
    cdef public Model model
    cdef public int n
    cdef public double rtol, t, t_old, t_input, h, error_old, energy_start, steps, rejected, rhs_calls
    cdef public double[::1] scale, relative, y, y_new, y_stage, k1, k2, k3, k4, k5, k6, k7, dense, u, u_rate, u_now, w
    cpdef void inputs_at(self, double t) noexcept
    cdef void move_inputs(self, double t) noexcept nogil
    cdef void slope(self, double t, double[::1] y, double[::1] dy) noexcept nogil
    cpdef void restart(self, double t) noexcept
    cpdef void refresh(self) noexcept
    cdef void stages(self, double h) noexcept nogil
    cdef double error(self, double h) noexcept nogil
    cdef void accept(self, double h) noexcept nogil
    cpdef bint advance(self, double t_end) noexcept
    cpdef void interpolate(self, double t, double[::1] y) noexcept
    cpdef void outputs_at(self, double t, double[::1] y, double[::1] out) noexcept
