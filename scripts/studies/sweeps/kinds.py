"""Every sweep by the name of its results."""
from studies.accuracy.sweep import AccuracySweep
from studies.time_outs.sweep import TimeOutsSweep
from studies.deadlock.sweep import DeadlockSweep

SWEEPS = {kind.name: kind for kind in [DeadlockSweep, AccuracySweep, TimeOutsSweep]}
