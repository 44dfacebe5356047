include(${CMAKE_CURRENT_LIST_DIR}/OpenSceneGraphTarget.cmake)
set(GEOFX_OSG_PLUGIN_DIR osgPlugins-${OPENSCENEGRAPH_VERSION}
    CACHE INTERNAL "Folder in which osgDB looks for plugins, relative to the library folder")

find_package(Threads REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(LibXml2 REQUIRED)

if(GEOFX_BUILD_DATA)
  find_package(GDAL 3.6 CONFIG REQUIRED)
  find_package(OpenImageIO CONFIG REQUIRED)
  # Debian's package names OpenCV's headers, which neither it nor we need, and CMake stops where they are missing.
  get_target_property(geofx_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER geofx_oiio_includes EXCLUDE REGEX opencv)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${geofx_oiio_includes}")
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(GeographicLib REQUIRED IMPORTED_TARGET geographiclib)
  pkg_check_modules(Deflate REQUIRED IMPORTED_TARGET libdeflate)
  # Not by pkg-config: the file of Debian's package names folders that are not there.
  find_library(GEOFX_SQUISH_LIBRARY squish REQUIRED)
  find_path(GEOFX_SQUISH_INCLUDE squish.h REQUIRED)
  add_library(geofx_squish INTERFACE IMPORTED)
  set_target_properties(geofx_squish PROPERTIES INTERFACE_LINK_LIBRARIES "${GEOFX_SQUISH_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${GEOFX_SQUISH_INCLUDE}")
endif()
if(GEOFX_BUILD_APPS)
  find_package(CLI11 CONFIG REQUIRED)
  find_package(nlohmann_json CONFIG REQUIRED)
endif()
if(GEOFX_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck CONFIG REQUIRED)
endif()
