# What vts stands on. Debian 12 needs two corrections, each explained where it is made.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(embree 3 REQUIRED)
pkg_check_modules(CMOCKA IMPORTED_TARGET cmocka)
pkg_check_modules(FREETYPE REQUIRED IMPORTED_TARGET freetype2)
pkg_check_modules(ZLIB REQUIRED IMPORTED_TARGET zlib) # which FreeType needs, too
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)

# GeographicLib: newer packages bring a config file, Debian 12 only a .pc file.
find_package(GeographicLib CONFIG QUIET)
if(NOT TARGET GeographicLib::GeographicLib)
  pkg_check_modules(GEOGRAPHICLIB REQUIRED IMPORTED_TARGET geographiclib)
  add_library(GeographicLib::GeographicLib ALIAS PkgConfig::GEOGRAPHICLIB)
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
