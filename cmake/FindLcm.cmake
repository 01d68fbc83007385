# Lcm::lcm and LCM_GEN. Debian ships no CMake config for LCM, and its pkg-config
# file asks for glib's headers, which users of LCM do not need.
find_path(Lcm_INCLUDE_DIR lcm/lcm-cpp.hpp)
find_library(Lcm_LIBRARY lcm)
find_program(LCM_GEN lcm-gen)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Lcm REQUIRED_VARS Lcm_LIBRARY Lcm_INCLUDE_DIR LCM_GEN)
if(Lcm_FOUND AND NOT TARGET Lcm::lcm)
  add_library(Lcm::lcm UNKNOWN IMPORTED)
  set_target_properties(Lcm::lcm PROPERTIES
    IMPORTED_LOCATION ${Lcm_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${Lcm_INCLUDE_DIR})
endif()
