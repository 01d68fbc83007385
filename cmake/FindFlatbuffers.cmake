# Flatbuffers::flatbuffers (headers alone) and FLATC. Debian's CMake config is part of the
# development package, its compiler another package: here both are asked for.
find_path(Flatbuffers_INCLUDE_DIR flatbuffers/flatbuffers.h)
find_program(FLATC flatc)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Flatbuffers REQUIRED_VARS Flatbuffers_INCLUDE_DIR FLATC)
if(Flatbuffers_FOUND AND NOT TARGET Flatbuffers::flatbuffers)
  add_library(Flatbuffers::flatbuffers INTERFACE IMPORTED)
  set_target_properties(Flatbuffers::flatbuffers PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES ${Flatbuffers_INCLUDE_DIR})
endif()
