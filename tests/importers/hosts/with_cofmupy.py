"""CoFmuPy: its coordinator, parameters as initialisation, inputs as literal streams.

It sets every input at every step, and reals only.
"""

from cofmupy import Coordinator
from job import host


def land(fmu, job):
    # a stream holds its previous value, so the change is set a quarter step early: the time that
    # CoFmuPy sums up is not exact
    change = (job["inputs_after"] - 0.25) * job["step"]
    streams = [
        {
            "source": {
                "type": "literal",
                "values": {"0": 0.0, repr(change): value},
                "interpolation": "previous",
            },
            "target": [{"id": "landing", "variable": name, "unit": "", "type": "fmu"}],
        }
        for name, value in job["inputs"].items()
    ]
    coordinator = Coordinator()
    coordinator.start(
        {
            "fmus": [{"id": "landing", "path": fmu, "initialization": job["parameters"]}],
            "connections": streams,
        }
    )
    time = 0.0
    for _ in range(job["steps"]):
        coordinator.do_step(job["step"])
        time = coordinator.master.current_time
        outputs = coordinator.master.get_outputs()["landing"]
        yield [time, *(outputs[name][0] for name in job["outputs"])]


host(land)
