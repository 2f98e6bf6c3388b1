# cmake -D BUILD= -D CONSUMER= -D EXAMPLES= -D WORK= -D VERSION= -D COMPILER= -P consume.cmake
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

# No file of the package may point back to where it was built.
file(GLOB_RECURSE texts ${WORK}/prefix/*.cmake ${WORK}/prefix/*.hpp)
foreach(text ${texts})
  file(READ ${text} content)
  string(FIND "${content}" "${BUILD}" at)
  if(NOT at EQUAL -1)
    message(FATAL_ERROR "${text} names the build folder")
  endif()
endforeach()

run(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/build -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
  -D CMAKE_CXX_COMPILER=${COMPILER} -D WANTED_VERSION=${VERSION})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer)
message(STATUS "${output}")

# The examples of the docs, against the installed library and its machine files.
run(${CMAKE_COMMAND} -S ${EXAMPLES} -B ${WORK}/examples -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
  -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${WORK}/examples)
foreach(example embed kinematics)
  run(${WORK}/examples/${example} ${WORK}/prefix/share/meridian/machines/lai.toml)
  message(STATUS "${example}: ${output}")
endforeach()

# Drives of one's own, which need nothing but the package; cut_with_drives.cmake runs them.
file(GLOB drive_library ${WORK}/prefix/lib*/libmeridian-drive.so ${WORK}/prefix/lib*/*/libmeridian-drive.so)
if(drive_library)
  foreach(header drive.hpp drive_axis.hpp drive_hardware.hpp drive_action.hpp drive_csp.hpp)
    file(STRINGS ${WORK}/prefix/include/meridian/${header} foreign REGEX "# *include \"")
    list(FILTER foreign EXCLUDE REGEX "meridian/drive_[a-z]+.hpp")
    if(foreign)
      message(FATAL_ERROR "${header} includes more than the standard library: ${foreign}")
    endif()
  endforeach()
  run(${CMAKE_COMMAND} -S ${EXAMPLES}/drives -B ${WORK}/drives -G Ninja -D CMAKE_PREFIX_PATH=${WORK}/prefix
    -D CMAKE_CXX_COMPILER=${COMPILER})
  run(${CMAKE_COMMAND} --build ${WORK}/drives)
  file(READ ${EXAMPLES}/drives/my_drives.cpp text)
  string(REGEX REPLACE "[^\n]" "" line_ends "${text}")
  string(LENGTH "${line_ends}" count)
  if(count GREATER 30)
    message(FATAL_ERROR "the example has ${count} lines, and may have 30")
  endif()
endif()

# A package of another minor version is not what was asked for.
execute_process(COMMAND ${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/other -G Ninja
  -D CMAKE_PREFIX_PATH=${WORK}/prefix -D WANTED_VERSION=99.0
  RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
if(result EQUAL 0)
  message(FATAL_ERROR "version 99.0 was found though ${VERSION} is installed")
endif()

# The programs run from where they were installed.
foreach(program meridian meridiand)
  if(EXISTS ${WORK}/prefix/bin/${program})
    run(${WORK}/prefix/bin/${program} --version)
    message(STATUS "${program}: ${output}")
  endif()
endforeach()
