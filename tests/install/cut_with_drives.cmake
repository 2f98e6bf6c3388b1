# cmake -D CONSUMER= -D EXAMPLES= -D WORK= -P cut_with_drives.cmake: drives of one's own that consume.cmake built against the
# installed package cut the sample part.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
run(${CMAKE_COMMAND} -E env MERIDIAN_DRIVES=${WORK}/drives/my_drives MERIDIAN_MAX_MISSING=1000000
  ${EXAMPLES}/../../deploy/demo ${WORK}/prefix/bin ${WORK}/demo)
file(STRINGS ${WORK}/demo/drives.log actions REGEX "spindle")
if(NOT actions)
  message(FATAL_ERROR "it was not my_drives that cut the sample part")
endif()
message(STATUS "my_drives cut the sample part")
run(sh ${CONSUMER}/../check_c_drives ${WORK}/drives/c_drives ${WORK}/prefix)
message(STATUS "c_drives: ${output}")
