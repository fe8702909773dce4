# vts_module(NAME [DEPENDS folders…] [LIBRARIES external…]): declares the static library of src/NAME.
# The sources are all .c files of the folder, so that adding a file needs no edit here; shims of foreign libraries, which are built
# apart, are none of them.
function(vts_module name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;LIBRARIES" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${name}/*.c)
  list(FILTER sources EXCLUDE REGEX "_shim\\.c$")
  list(APPEND sources ${CMAKE_SOURCE_DIR}/cmake/empty.c)
  add_library(vts_${name} STATIC ${sources})
  target_include_directories(vts_${name} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  list(TRANSFORM ARG_DEPENDS PREPEND vts_)
  target_link_libraries(vts_${name} PUBLIC ${ARG_DEPENDS} PRIVATE vts_options ${ARG_LIBRARIES})
endfunction()

# vts_test(NAME folders…): one cmocka program from tests/unit/NAME.c.
function(vts_test name)
  add_executable(${name} ${CMAKE_SOURCE_DIR}/tests/unit/${name}.c)
  set(folders ${ARGN})
  list(TRANSFORM folders PREPEND vts_)
  target_link_libraries(${name} PRIVATE ${folders} vts_options PkgConfig::CMOCKA)
  target_compile_definitions(${name} PRIVATE VTS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS unit)
endfunction()
