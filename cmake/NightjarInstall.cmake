# What find_package(nightjar) gives: nightjar::esi, and nightjar::core which it needs.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/nightjar)
target_compile_features(nightjar_core PUBLIC cxx_std_20)
set_target_properties(nightjar_core PROPERTIES EXPORT_NAME core)
set_target_properties(nightjar_esi PROPERTIES EXPORT_NAME esi)
install(TARGETS nightjar_core nightjar_esi EXPORT nightjar
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT nightjar NAMESPACE nightjar:: FILE nightjarTargets.cmake
        DESTINATION ${package_folder})

install(DIRECTORY core DESTINATION include/nightjar FILES_MATCHING PATTERN "*.h")
install(DIRECTORY esi DESTINATION include/nightjar FILES_MATCHING PATTERN "*.h"
        PATTERN make_network.h EXCLUDE
        PATTERN onnx_signature.h EXCLUDE
        PATTERN recurrent_network.h EXCLUDE)

configure_package_config_file(cmake/nightjarConfig.cmake.in ${CMAKE_BINARY_DIR}/nightjarConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/nightjarConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/nightjarConfig.cmake
              ${CMAKE_BINARY_DIR}/nightjarConfigVersion.cmake
        DESTINATION ${package_folder})
