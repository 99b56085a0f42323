"""Studies: what is measured of the machine and of the simulator, and the tables and charts that come of it."""
import os

os.environ["MPLBACKEND"] = "Agg"  # charts are files: no display is needed
