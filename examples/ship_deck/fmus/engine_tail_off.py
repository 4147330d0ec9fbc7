"""A rocket engine that is cut off: full thrust up to the cut-off, then an exponential decay."""

from math import cos, exp, sin

from described import DescribedSlave


class EngineTailOff(DescribedSlave):
    """Force on the body in the inertial frame and moment about its CG.

    They are the inputs `external.*` of RlvLanding.
    """

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.parameter("thrust", "N", 1700.0, "thrust up to the cut-off")
        self.parameter("cut_off", "s", 0.3, "time of the cut-off")
        self.parameter(
            "decay", "s", 0.08, "time constant of the decay; its impulse is thrust times decay"
        )
        self.parameter(
            "direction", "rad", 0.0, "angle of the thrust from the vertical, clockwise positive"
        )
        self.parameter(
            "arm",
            "m",
            0.0,
            "distance by which the thrust's line misses the CG to the left (-x): turns clockwise",
        )
        self.output("force_x", "N", "thrust along inertial x")
        self.output("force_y", "N", "thrust along inertial y (up)")
        self.output("moment", "N.m", "moment of the thrust about the CG, clockwise positive")

    def exit_initialization_mode(self):
        """Set the outputs at time 0."""
        self.burn(0.0)

    def do_step(self, current_time, step_size):
        """Set the outputs at the end of the step."""
        self.burn(current_time + step_size)
        return True

    def burn(self, time: float) -> None:
        """Set the outputs at `time` [s]."""
        force = self.thrust * exp(-max(0.0, time - self.cut_off) / self.decay)
        self.force_x, self.force_y = force * sin(self.direction), force * cos(self.direction)
        self.moment = force * self.arm
