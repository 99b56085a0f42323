"""Studies: measurements of the machine and of the simulator, and their tables and charts."""
import os

os.environ["MPLBACKEND"] = "Agg"  # charts are files: no display is needed
