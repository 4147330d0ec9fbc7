"""FMUGym: the FMU as an environment of Gymnasium.

It extracts and starts the FMU anew at every reset. Its observations are single precision, so the
rows come from its `info`.
"""

import numpy as np
from fmugym.fmugym import FMUGym
from fmugym.fmugym_config import FMUGymConfig, VarSpace
from job import host


class Environment(FMUGym):
    def __init__(self, config, job):
        self.job = job
        super().__init__(config)

    def _noisy_init(self):
        references = {v.name: v.valueReference for v in self.fmu_description.modelVariables}
        return {references[name]: value for name, value in self.job["parameters"].items()}

    def _get_info(self):
        references = [self.output_dict[name] for name in self.job["outputs"]]
        return {"values": self.fmu.getReal(references)}

    def _process_reward(self, obs, acts, info):
        return 0.0

    def compute_reward(self, achieved_goal, desired_goal, info):
        return 0.0


def land(fmu, job):
    inputs, outputs, nothing = VarSpace("inputs"), VarSpace("outputs"), VarSpace("nothing")
    for name in job["inputs"]:
        inputs.add_var_box(name, -1e4, 1e4)
    for name in job["outputs"]:
        outputs.add_var_box(name, -1e9, 1e9)
    config = FMUGymConfig(
        fmu_path=fmu,
        start_time=0.0,
        stop_time=2.0 * job["steps"] * job["step"],
        sim_step_size=job["step"],
        action_step_size=job["step"] / 2,
        inputs=inputs,
        input_noise=nothing,
        outputs=outputs,
        output_noise=nothing,
        random_vars=nothing,
    )
    environment = Environment(config, job)
    environment.reset()
    order = {name: i for i, name in enumerate(environment.input_dict)}
    action = np.zeros(len(order))
    for k in range(1, job["steps"] + 1):
        info = environment.step(action)[4]
        yield [environment.time, *info["values"]]
        if k == job["inputs_after"]:
            for name, value in job["inputs"].items():
                action[order[name]] = value
    environment.close()


host(land)
