// Errors put in on purpose, to see that the vectors find them: +fault=N in a build with DATAPATH_FAULTS.
`ifdef DATAPATH_FAULTS
  int fault;
  initial if ($value$plusargs("fault=%d", fault) == 0) fault = 0;
`else
  localparam int fault = 0;
`endif
