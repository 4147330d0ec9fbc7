"""The landing node: settings, parameters, lifecycle, inputs, pacing and publishing."""
