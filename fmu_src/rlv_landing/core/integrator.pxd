cdef double SAFETY, SHRINK, GROW, BETA, FIRST_STEP, LONGEST_STEP, SHORTEST_STEP
cdef class Solver:
    cdef public Model model
    cdef public int n, row
    cdef public double rtol, t, t_old, t_input, h, error_old, energy_start, exponent, steps, rejected, rhs_calls
    cdef public double[::1] scale, relative, y, y_new, y_stage, k1, k2, k3, k4, k_end, deviation, dense, u, u_rate, u_now, w
    cpdef void inputs_at(self, double t) noexcept
    cdef void move_inputs(self, double t) noexcept nogil
    cpdef void derivatives(self, double t, double[::1] y, double[::1] dy) noexcept
    cdef void slope(self, double t, double* y, double* dy) noexcept nogil
    cpdef void restart(self, double t) noexcept
    cpdef void refresh(self) noexcept
    cdef void attempt(self, double h) noexcept nogil
    cdef double error(self) noexcept nogil
    cdef void bend(self, double h) noexcept nogil
    cdef void begin(self) noexcept nogil
    cdef void accept(self, double h) noexcept nogil
    cdef bint go_to(self, double t_end) noexcept nogil
    cpdef bint advance(self, double t_end) noexcept
    cdef void state_at(self, double t, double* y) noexcept nogil
    cpdef void interpolate(self, double t, double[::1] y) noexcept
    cpdef void outputs_at(self, double t, double[::1] y, double[::1] out) noexcept
    cdef int fill(self, double start, double every, int first, int last, double* rows) noexcept nogil
    cpdef int record(self, double start, double every, int first, int last, double[::1] rows) noexcept
