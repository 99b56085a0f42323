// Errors put in on purpose, to see that the vectors find them: +fault=N in a build with DATAPATH_FAULTS; in a whole
// cell that is built with RTL_FAULTS, its numbers from FIRST on.
`ifdef RTL_FAULTS
  import raycell_numbers::fault;
  localparam int FIRST = raycell_numbers::FAULT_DATAPATH;
`else
  localparam int FIRST = 0;
`ifdef DATAPATH_FAULTS
  int fault;
  initial if ($value$plusargs("fault=%d", fault) == 0) fault = 0;
`else
  localparam int fault = 0;
`endif
`endif
