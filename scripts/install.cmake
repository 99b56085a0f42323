# cmake --install: libraries and headers for projects of others, found by find_package(Raycell); programs and presets.
include(CMakePackageConfigHelpers)
foreach(room model cells pipeline)
  add_library(raycell::${room} ALIAS raycell_${room})
  set_target_properties(raycell_${room} PROPERTIES EXPORT_NAME ${room})
  install(TARGETS raycell_${room} EXPORT Raycell ARCHIVE DESTINATION lib)
  install(DIRECTORY ${room} DESTINATION include/raycell FILES_MATCHING PATTERN "*.hpp" PATTERN truth EXCLUDE)
endforeach()
install(EXPORT Raycell NAMESPACE raycell:: FILE RaycellTargets.cmake DESTINATION lib/cmake/Raycell)
configure_package_config_file(scripts/RaycellConfig.cmake.in ${CMAKE_BINARY_DIR}/RaycellConfig.cmake
    INSTALL_DESTINATION lib/cmake/Raycell)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/RaycellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/RaycellConfig.cmake ${CMAKE_BINARY_DIR}/RaycellConfigVersion.cmake
    DESTINATION lib/cmake/Raycell)
if(RAYCELL_PROGRAMS)
  install(TARGETS raycell deadlock_tb loading_tb cell_tb RUNTIME DESTINATION bin)
  install(DIRECTORY presets DESTINATION share/raycell FILES_MATCHING PATTERN "*.toml")
endif()
