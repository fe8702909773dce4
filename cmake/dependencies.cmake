# What vts stands on. Debian 12 needs three corrections, each explained where it is made.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(embree 3 REQUIRED)
pkg_check_modules(CMOCKA IMPORTED_TARGET cmocka)

# GeographicLib: newer packages bring a config file, Debian 12 only a .pc file.
find_package(GeographicLib CONFIG QUIET)
if(NOT TARGET GeographicLib::GeographicLib)
  pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
  add_library(GeographicLib::GeographicLib ALIAS PkgConfig::GEOGRAPHICLIB)
endif()

# OpenImageIO: Debian's exported target names an include folder of OpenCV that its package does not depend on, and CMake
# refuses folders that do not exist; keep those that do.
find_package(OpenImageIO REQUIRED)
get_target_property(_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
set(_oiio_existing "")
foreach(_folder IN LISTS _oiio_includes)
  if(_folder MATCHES "^\\$<" OR IS_DIRECTORY "${_folder}")
    list(APPEND _oiio_existing "${_folder}")
  endif()
endforeach()
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${_oiio_existing}")
