"""A Temperature Control Lab (tclab). Not run by the tests: it needs the kit."""

import time

import tclab

from tunewright import autotune

with tclab.TCLab() as lab:
    lab.Q1(30)
    time.sleep(900)  # it is warm
    tuned = autotune(lambda: lab.T1, lab.Q1, u=30, sample_time=2, u_step=15, u_min=0, u_max=100, y_max=80, u_safe=0)
    print(tuned.controller)
