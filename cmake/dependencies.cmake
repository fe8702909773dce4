# What vts stands on. Debian 12 needs two corrections, each explained where it is made.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(embree 3 REQUIRED)
pkg_check_modules(CMOCKA IMPORTED_TARGET cmocka)
pkg_check_modules(FREETYPE REQUIRED IMPORTED_TARGET freetype2)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib) # which FreeType needs, too
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)

# GeographicLib: newer packages bring a config file, Debian 12 only a .pc file.
# Where there is an archive of it that fits into a shared library it is taken, and libstdc++ goes the same way: nothing else
# asks for it, and its many symbols cost every start more than a millisecond.
find_package(GeographicLib CONFIG QUIET)
set(GEOGRAPHICLIB_OPTIONS -static-libstdc++ -static-libgcc -Wl,--exclude-libs,ALL)
find_library(GEOGRAPHICLIB_ARCHIVE NAMES ${CMAKE_STATIC_LIBRARY_PREFIX}GeographicLib${CMAKE_STATIC_LIBRARY_SUFFIX} ${CMAKE_STATIC_LIBRARY_PREFIX}Geographic${CMAKE_STATIC_LIBRARY_SUFFIX})
if(GEOGRAPHICLIB_ARCHIVE AND NOT VTS_SANITIZE AND NOT VTS_FUZZ)
  include(CheckCXXSourceCompiles)
  set(CMAKE_REQUIRED_LINK_OPTIONS -shared ${GEOGRAPHICLIB_OPTIONS})
  set(CMAKE_REQUIRED_LIBRARIES ${GEOGRAPHICLIB_ARCHIVE})
  check_cxx_source_compiles("#include <GeographicLib/Geodesic.hpp>
    double f() { double x; return GeographicLib::Geodesic::WGS84().Inverse(0, 0, 1, 1, x); }" GEOGRAPHICLIB_ARCHIVE_FITS)
  unset(CMAKE_REQUIRED_LIBRARIES)
  unset(CMAKE_REQUIRED_LINK_OPTIONS)
endif()
if(GEOGRAPHICLIB_ARCHIVE_FITS)
  add_library(vts_geographiclib INTERFACE)
  target_link_libraries(vts_geographiclib INTERFACE ${GEOGRAPHICLIB_ARCHIVE})
  target_link_options(vts_geographiclib INTERFACE ${GEOGRAPHICLIB_OPTIONS})
  set(VTS_GEOGRAPHICLIB vts_geographiclib)
elseif(TARGET GeographicLib::GeographicLib)
  set(VTS_GEOGRAPHICLIB GeographicLib::GeographicLib)
else()
  pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
  set(VTS_GEOGRAPHICLIB PkgConfig::GEOGRAPHICLIB)
endif()

# OpenImageIO through its .pc file: Debian's exported CMake target names an include folder and a program of packages that
# the library's own does not depend on, and CMake refuses both.
pkg_check_modules(OPENIMAGEIO REQUIRED IMPORTED_TARGET OpenImageIO)

# libgeotiff has neither a .pc file nor, on Debian, a config file; it reads TIFF through libtiff and looks codes up with PROJ.
pkg_check_modules(TIFF REQUIRED IMPORTED_TARGET libtiff-4)
pkg_check_modules(PROJ REQUIRED IMPORTED_TARGET proj)
find_path(GEOTIFF_INCLUDE_DIR geotiff.h PATH_SUFFIXES geotiff libgeotiff REQUIRED)
find_library(GEOTIFF_LIBRARY geotiff REQUIRED)
add_library(GeoTIFF::GeoTIFF UNKNOWN IMPORTED)
set_target_properties(GeoTIFF::GeoTIFF PROPERTIES IMPORTED_LOCATION ${GEOTIFF_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${GEOTIFF_INCLUDE_DIR})
