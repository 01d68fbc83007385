# Installs the build in BUILD to a folder of its own, builds the project beside this file
# with find_package(nightjar) from there, runs it, and looks at what it links.
# cmake -D BUILD=... -D CXX=... -D FLAGS=... -P check.cmake

set(work ${BUILD}/install-test)
file(REMOVE_RECURSE ${work})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0)
    file(REMOVE_RECURSE ${work})
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${result}\n${out}")
  endif()
  set(out "${out}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${work}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${work}/prefix -DCMAKE_CXX_COMPILER=${CXX} "-DCMAKE_CXX_FLAGS=${FLAGS}")
run(${CMAKE_COMMAND} --build ${work}/build)
run(${work}/build/consumer)
message("consumer: ${out}")
run(ldd ${work}/build/consumer)
file(GLOB_RECURSE headers RELATIVE ${work}/prefix ${work}/prefix/*.h)
file(REMOVE_RECURSE ${work})

# The compiler's own and what core needs; Eigen is headers.
string(REGEX MATCHALL "\t[^ \n]+" libraries "${out}")
if(NOT libraries)
  message(FATAL_ERROR "ldd said: ${out}")
endif()
foreach(library ${libraries})
  if(NOT library MATCHES "^\tlib(fmt|stdc\\+\\+|m|gcc_s|c|asan|ubsan|tsan)\\.so|linux")
    message(FATAL_ERROR "the consumer links ${library}")
  endif()
endforeach()
foreach(header ${headers})
  if(NOT header MATCHES "^include/nightjar/(core|esi)/[a-z0-9_]+\\.h$")
    message(FATAL_ERROR "${header} was installed")
  endif()
endforeach()
