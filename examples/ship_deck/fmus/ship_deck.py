"""A ship's deck that heaves and rolls: two sinusoids that start smoothly from rest."""

from math import cos, pi, sin

from described import DescribedSlave


def sinusoid(
    time: float, amplitude: float, period: float, phase: float, start_up: float
) -> tuple[float, float]:
    """Value and rate of a sinusoid that fades in with (1 - cos)/2 and starts from rest.

    Args:
        time: Time [s].
        amplitude: Amplitude.
        period: Period [s].
        phase: Phase at time 0 [rad].
        start_up: Duration of the fade [s].
    """
    omega = 2.0 * pi / period
    wave, wave_rate = (
        amplitude * sin(omega * time + phase),
        amplitude * omega * cos(omega * time + phase),
    )
    if time >= start_up:
        return wave, wave_rate
    fade, fade_rate = (
        0.5 - 0.5 * cos(pi * time / start_up),
        0.5 * pi / start_up * sin(pi * time / start_up),
    )
    return fade * wave, fade_rate * wave + fade * wave_rate


class ShipDeck(DescribedSlave):
    """Heave (up) and tilt (clockwise positive) of the deck with their rates.

    They are the inputs `ground.*` of RlvLanding.
    """

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.parameter("heave_amplitude", "m", 0.15, "amplitude of the heave")
        self.parameter("heave_period", "s", 4.0, "period of the heave")
        self.parameter("heave_phase", "rad", 0.0, "phase of the heave at time 0")
        self.parameter("tilt_amplitude", "rad", 0.03, "amplitude of the tilt")
        self.parameter("tilt_period", "s", 6.0, "period of the tilt")
        self.parameter("tilt_phase", "rad", 0.0, "phase of the tilt at time 0")
        self.parameter(
            "start_up", "s", 0.5, "time over which the motion fades in; 0: it starts at once"
        )
        self.output("heave", "m", "lift of the deck")
        self.output("heave_rate", "m/s", "rate of the lift")
        self.output("tilt", "rad", "tilt of the deck, clockwise positive")
        self.output("tilt_rate", "rad/s", "rate of the tilt")

    def exit_initialization_mode(self):
        """Set the outputs at time 0."""
        self.move(0.0)

    def do_step(self, current_time, step_size):
        """Set the outputs at the end of the step."""
        self.move(current_time + step_size)
        return True

    def move(self, time: float) -> None:
        """Set the outputs at `time` [s]."""
        self.heave, self.heave_rate = sinusoid(
            time, self.heave_amplitude, self.heave_period, self.heave_phase, self.start_up
        )
        self.tilt, self.tilt_rate = sinusoid(
            time, self.tilt_amplitude, self.tilt_period, self.tilt_phase, self.start_up
        )
