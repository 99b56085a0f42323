"""Every sweep by the name of its results."""
from chart_accuracy import AccuracySweep
from chart_time_outs import TimeOutsSweep
from sweep_deadlock import DeadlockSweep

SWEEPS = {kind.name: kind for kind in [DeadlockSweep, AccuracySweep, TimeOutsSweep]}
