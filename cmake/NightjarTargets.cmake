# The few shapes of target this project has.

add_library(nightjar_options INTERFACE)
target_compile_options(nightjar_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
                                                  -Wno-sign-conversion)
if(NIGHTJAR_SANITIZE)
  target_compile_options(nightjar_options INTERFACE -fsanitize=${NIGHTJAR_SANITIZE}
                                                    -fno-sanitize-recover=all)
  target_link_options(nightjar_options INTERFACE -fsanitize=${NIGHTJAR_SANITIZE})
endif()
# No contraction into multiply-adds, so that what we compile gives the same bits
# whichever instruction set is chosen at run time. The C library and llvmpipe choose
# for themselves: results are the same on one kind of machine.
target_compile_options(nightjar_options INTERFACE -ffp-contract=off)

# nightjar_library(NAME [SOURCES files...] [EXCEPT files...] [PUBLIC libs...]
# [PRIVATE libs...]): SOURCES, or else every .cc of the folder NAME but for EXCEPT, as one
# static library.
function(nightjar_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;EXCEPT;PUBLIC;PRIVATE" ${ARGN})
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${name}/*.cc)
    foreach(file ${arg_EXCEPT})
      list(REMOVE_ITEM arg_SOURCES ${CMAKE_SOURCE_DIR}/${file})
    endforeach()
  endif()
  add_library(nightjar_${name} STATIC ${arg_SOURCES})
  target_include_directories(nightjar_${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
                                                     $<INSTALL_INTERFACE:include/nightjar>)
  target_link_libraries(nightjar_${name} PUBLIC ${arg_PUBLIC}
                        PRIVATE $<BUILD_INTERFACE:nightjar_options> ${arg_PRIVATE})
endfunction()

# nightjar_lcm_types(NAME FOLDER): C++ classes made by lcm-gen from FOLDER/*.lcm,
# included as "nightjar_lcm/<type>.hpp".
function(nightjar_lcm_types name folder)
  file(GLOB schemas CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.lcm)
  set(out ${CMAKE_BINARY_DIR}/lcm)
  set(headers)
  foreach(schema ${schemas})
    get_filename_component(type ${schema} NAME_WE)
    set(header ${out}/nightjar_lcm/${type}.hpp)
    add_custom_command(OUTPUT ${header}
      COMMAND ${LCM_GEN} --cpp --cpp-hpath ${out} --cpp-std=c++11 ${schema}
      DEPENDS ${schema} VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(nightjar_${name}_gen DEPENDS ${headers})
  add_library(nightjar_${name} INTERFACE)
  target_include_directories(nightjar_${name} SYSTEM INTERFACE ${out})
  add_dependencies(nightjar_${name} nightjar_${name}_gen)
endfunction()

# nightjar_flatbuffers(NAME FOLDER): C++ classes made by flatc from FOLDER/*.fbs,
# included as "nightjar_flatbuffers/<schema>_generated.h".
function(nightjar_flatbuffers name folder)
  file(GLOB schemas CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/${folder}/*.fbs)
  set(out ${CMAKE_BINARY_DIR}/flatbuffers)
  set(headers)
  foreach(schema ${schemas})
    get_filename_component(stem ${schema} NAME_WE)
    set(header ${out}/nightjar_flatbuffers/${stem}_generated.h)
    add_custom_command(OUTPUT ${header}
      COMMAND ${FLATC} --cpp -o ${out}/nightjar_flatbuffers ${schema}
      DEPENDS ${schema} VERBATIM)
    list(APPEND headers ${header})
  endforeach()
  add_custom_target(nightjar_${name}_gen DEPENDS ${headers})
  add_library(nightjar_${name} INTERFACE)
  target_include_directories(nightjar_${name} SYSTEM INTERFACE ${out})
  target_link_libraries(nightjar_${name} INTERFACE Flatbuffers::flatbuffers)
  add_dependencies(nightjar_${name} nightjar_${name}_gen)
endfunction()
