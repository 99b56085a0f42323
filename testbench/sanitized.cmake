# The model and the readers once more under AddressSanitizer and UndefinedBehaviorSanitizer, with their own tests.
if(NOT RAYCELL_SANITIZE)
  set(RAYCELL_SANITIZERS -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined
      -fno-omit-frame-pointer)
  function(raycell_sanitized target)
    target_compile_options(${target} PRIVATE ${RAYCELL_SANITIZERS})
    target_link_options(${target} PUBLIC -fsanitize=address,undefined)
  endfunction()

  file(GLOB model_sources CONFIGURE_DEPENDS ../model/*/*.cpp)
  list(FILTER model_sources EXCLUDE REGEX "/truth/")
  raycell_library(raycell_sanitized ${model_sources} microcode/*trials.cpp microcode/counts.cpp ../scenes/*.cpp)
  target_link_libraries(raycell_sanitized PUBLIC glm::glm PRIVATE tinyobjloader::tinyobjloader_double)
  raycell_sanitized(raycell_sanitized)

  foreach(room model scenes)
    add_executable(${room}_tests_sanitized ${${room}_tests})
    target_link_libraries(${room}_tests_sanitized PRIVATE raycell_sanitized GTest::gtest_main)
    target_compile_definitions(${room}_tests_sanitized PRIVATE ${RAYCELL_TEST_DEFINITIONS} RAYCELL_SANITIZED)
    raycell_sanitized(${room}_tests_sanitized)
    add_test(NAME "sanitized: ${room}" COMMAND ${room}_tests_sanitized --gtest_brief=1)
    set_tests_properties("sanitized: ${room}" PROPERTIES TIMEOUT 900)
  endforeach()

  # The reader of golden vectors: it needs SystemC's types, so its tests have an sc_main.
  add_executable(golden_tests_sanitized tests/sc_main.cpp ${golden_tests} golden/words.cpp golden/messages.cpp
      golden/file.cpp golden/setup.cpp golden/packing.cpp golden/memory_file.cpp golden/traversal.cpp
      rtl/package.cpp)
  target_link_libraries(golden_tests_sanitized PRIVATE raycell_sanitized PkgConfig::SYSTEMC GTest::gtest)
  raycell_sanitized(golden_tests_sanitized)
  add_test(NAME "sanitized: golden" COMMAND golden_tests_sanitized --gtest_brief=1)
  set_tests_properties("sanitized: golden" PROPERTIES TIMEOUT 900)
endif()
