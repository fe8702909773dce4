# Compiler options of every target of ours.
add_library(vts_options INTERFACE)
target_compile_options(vts_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -fvisibility=hidden
  $<$<COMPILE_LANGUAGE:C>:-Wstrict-prototypes -Wmissing-prototypes -Wdouble-promotion>
  # Contraction differs between machines and would make pictures differ; errno of sqrt() and floating-point traps, which
  # nothing here uses, hinder vectorisation.
  -ffp-contract=off -fno-math-errno -fno-trapping-math)
target_compile_definitions(vts_options INTERFACE _POSIX_C_SOURCE=200809L VTS_VERSION="${PROJECT_VERSION}")
if(CMAKE_C_COMPILER_ID STREQUAL "GNU")
  target_compile_options(vts_options INTERFACE $<$<COMPILE_LANGUAGE:C>:-fno-semantic-interposition>)
endif()
if(VTS_SANITIZE)
  target_compile_options(vts_options INTERFACE -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=undefined,float-cast-overflow -fno-omit-frame-pointer)
  target_link_options(vts_options INTERFACE -fsanitize=address,undefined)
endif()
if(VTS_FUZZ)
  target_compile_options(vts_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
