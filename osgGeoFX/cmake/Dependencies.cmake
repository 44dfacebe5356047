include(${CMAKE_CURRENT_LIST_DIR}/OpenSceneGraphTarget.cmake)
if(geofx_missing_osg)
  message(FATAL_ERROR "${geofx_missing_osg}")
endif()
# For contexts without a window alone.
find_package(OpenGL QUIET COMPONENTS EGL)
option(GEOFX_BUILD_OFFSCREEN "Build offscreen/ and the programs that stand on it (needs EGL)" ${OpenGL_EGL_FOUND})
if(GEOFX_BUILD_OFFSCREEN AND NOT OpenGL_EGL_FOUND)
  message(FATAL_ERROR "EGL was not found; on Debian install libegl-dev, or set GEOFX_BUILD_OFFSCREEN=OFF to build without.")
endif()
set(GEOFX_OSG_PLUGIN_DIR osgPlugins-${OPENSCENEGRAPH_VERSION}
    CACHE INTERNAL "Folder in which osgDB looks for plugins, relative to the library folder")

find_package(Threads REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(LibXml2 REQUIRED)

if(GEOFX_BUILD_MAPS OR GEOFX_BUILD_TESTS)
  find_package(OpenImageIO CONFIG REQUIRED)
  # Debian's package names OpenCV's headers, which neither it nor we need, and CMake stops where they are missing.
  get_target_property(geofx_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
  list(FILTER geofx_oiio_includes EXCLUDE REGEX opencv)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${geofx_oiio_includes}")
endif()
if(GEOFX_BUILD_DATA)
  find_package(GDAL 3.6 CONFIG REQUIRED)
  find_package(PkgConfig REQUIRED)
  pkg_check_modules(GeographicLib REQUIRED IMPORTED_TARGET geographiclib)
  pkg_check_modules(Deflate REQUIRED IMPORTED_TARGET libdeflate)
  # Draws vector data with smooth edges.
  pkg_check_modules(Cairo REQUIRED IMPORTED_TARGET cairo)
  # Not by pkg-config: the file of Debian's package names folders that are not there.
  find_library(GEOFX_SQUISH_LIBRARY squish REQUIRED)
  find_path(GEOFX_SQUISH_INCLUDE squish.h REQUIRED)
  add_library(geofx_squish INTERFACE IMPORTED)
  set_target_properties(geofx_squish PROPERTIES INTERFACE_LINK_LIBRARIES "${GEOFX_SQUISH_LIBRARY}"
                        INTERFACE_INCLUDE_DIRECTORIES "${GEOFX_SQUISH_INCLUDE}")
endif()
if(GEOFX_BUILD_MAPS)
  find_package(PkgConfig REQUIRED)
  # Lays out text in any script, and draws it as pixels, PDF and SVG.
  pkg_check_modules(Pango REQUIRED IMPORTED_TARGET pangocairo fontconfig cairo-pdf cairo-svg)
  # Its -pthread defines something that our precompiled headers do not know.
  set_target_properties(PkgConfig::Pango PROPERTIES INTERFACE_COMPILE_OPTIONS "")
  # The color profile of pictures.
  pkg_check_modules(Lcms REQUIRED IMPORTED_TARGET lcms2)
  # Web pages have a copy of it. It is needed only when one is written, so it may be installed later.
  find_path(GEOFX_LEAFLET leaflet.js PATHS /usr/share/javascript/leaflet PATH_SUFFIXES javascript/leaflet)
  if(NOT GEOFX_LEAFLET)
    message(STATUS "Leaflet was not found, so web pages cannot be written yet; on Debian install libjs-leaflet.")
    set(geofx_leaflet /usr/share/javascript/leaflet)
  else()
    set(geofx_leaflet ${GEOFX_LEAFLET})
  endif()
endif()
# Headers alone; nobody who links the libraries needs them.
find_package(nlohmann_json CONFIG REQUIRED)
if(GEOFX_BUILD_APPS)
  find_package(CLI11 CONFIG REQUIRED)
endif()
if(GEOFX_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_library(GEOFX_NOVA_LIBRARY nova REQUIRED)
  find_package(rapidcheck CONFIG REQUIRED)
endif()
