# The microprogrammed datapath in SystemVerilog, where there is a simulator.
find_program(VERILATOR verilator)
find_program(IVERILOG iverilog)
function(raycell_datapath_test title folder)
  add_test(NAME "rtl: ${title}" COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/rtl/datapath/check_vectors.py
      $<TARGET_FILE:microcode_tb> ${CMAKE_BINARY_DIR}/rtl-datapath/${folder} ${ARGN})
  set_tests_properties("rtl: ${title}" PROPERTIES TIMEOUT 600)
endfunction()
if(VERILATOR)
  foreach(bits 16 20 24)
    raycell_datapath_test("every microprogram does in SystemVerilog what it does in the model (words of ${bits} bits)"
        words-${bits} ${bits} --runs 60)
  endforeach()
  set(title "rtl: the traversal unit in SystemVerilog decides about every ray of 16 cells as the model does (interval)")
  add_test(NAME ${title} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/rtl/datapath/check_traversal.py ${CMAKE_BINARY_DIR}
      ${CMAKE_BINARY_DIR}/rtl-datapath/traversal-interval ${CMAKE_SOURCE_DIR}/scenes/still_life.nff interval 20)
  set_tests_properties(${title} PROPERTIES TIMEOUT 600)
  set(title "rtl: the traversal and shading units in SystemVerilog test the rays of 16 cells and shade their hits as the model does")
  add_test(NAME ${title} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/rtl/datapath/check_shading.py ${CMAKE_BINARY_DIR}
      ${CMAKE_BINARY_DIR}/rtl-datapath/shading ${CMAKE_SOURCE_DIR}/scenes/still_life.nff edge 20 --traversal)
  set_tests_properties(${title} PROPERTIES TIMEOUT 600)
  set(title "rtl: loading in SystemVerilog makes the voxels of 16 cells as the model does")
  add_test(NAME ${title} COMMAND ${CMAKE_CURRENT_SOURCE_DIR}/rtl/datapath/check_loading.py ${CMAKE_BINARY_DIR}
      ${CMAKE_BINARY_DIR}/rtl-datapath/loading ${CMAKE_SOURCE_DIR}/scenes/still_life.nff 20)
  set_tests_properties(${title} PROPERTIES TIMEOUT 600)
  raycell_datapath_test("vectors find every error put into the datapath on purpose" faults 20 --runs 20 --faults)
endif()
if(IVERILOG)
  raycell_datapath_test("Icarus runs the traversal's microprograms as Verilator does" icarus 16 --runs 5 --icarus
      --programs "walk,leave,run,run outwards,interval,plane,edge")
endif()
