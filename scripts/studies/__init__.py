"""Studies: what is measured of the machine and of the simulator, and the tables and charts that come of it."""
