# How long the dynamic loader takes for a library with hundreds of others behind it depends on the order of loading: what is
# loaded together looks for each of its symbols in all of them, one after another; what is loaded alone, only in its own.

# The names of those libraries behind `library` that bind MANY symbols of data or more when they are loaded, those that others
# stand on first. Empty where ldd and readelf are not at hand or do not know: then all are loaded together.
function(vts_heavy_libraries library out)
  set(MANY 1000)
  set(${out} "" PARENT_SCOPE)
  find_program(VTS_LDD ldd)
  find_program(VTS_READELF NAMES ${CMAKE_READELF} readelf)
  mark_as_advanced(VTS_LDD VTS_READELF)
  if(NOT VTS_LDD OR NOT VTS_READELF)
    return()
  endif()
  execute_process(COMMAND ${VTS_LDD} ${library} OUTPUT_VARIABLE listing ERROR_QUIET)
  string(REGEX MATCHALL "=> /[^ \n]+" paths "${listing}")
  list(TRANSFORM paths REPLACE "^=> " "")
  list(REVERSE paths) # ldd names who needs a library before it
  execute_process(COMMAND ${VTS_READELF} -dW ${paths} OUTPUT_VARIABLE sections ERROR_QUIET)
  # One line a library, without the characters that lists of CMake are made of.
  string(REGEX REPLACE "[][;]" "" sections "${sections}")
  string(REPLACE "File: " ";" sections "${sections}")
  set(heavy "")
  foreach(section IN LISTS sections)
    if(NOT section MATCHES "^[^\n]*/([^/\n]+)\n")
      continue()
    endif()
    set(name ${CMAKE_MATCH_1})
    if(NOT section MATCHES "\\(RELASZ\\) +([0-9]+)")
      continue()
    endif()
    math(EXPR symbols "${CMAKE_MATCH_1} / 24") # sizeof(Elf64_Rela)
    if(section MATCHES "\\(RELACOUNT\\) +([0-9]+)")
      math(EXPR symbols "${symbols} - ${CMAKE_MATCH_1}") # those that only move addresses need no symbol
    endif()
    if(symbols GREATER_EQUAL MANY)
      list(APPEND heavy ${name})
    endif()
  endforeach()
  set(${out} "${heavy}" PARENT_SCOPE)
endfunction()
