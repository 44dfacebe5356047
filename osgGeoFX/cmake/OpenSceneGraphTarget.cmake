# Debian's OpenSceneGraph 3.6.5 ships no CMake package; CMake's own module finds it, without targets.
# This wraps what it finds into one imported target, for our build and, installed, for a consumer's. Where there is none,
# geofx_missing_osg is the sentence that says so, and there is no target.
set(geofx_missing_osg "")
if(NOT TARGET osgGeoFX::OpenSceneGraph)
  find_package(OpenSceneGraph 3.6.5 QUIET MODULE COMPONENTS osgDB osgGA osgText osgUtil osgViewer osgTerrain)
  find_package(OpenGL QUIET COMPONENTS OpenGL)
  if(NOT OPENSCENEGRAPH_FOUND)
    set(geofx_missing_osg "OpenSceneGraph 3.6.5 or newer was not found; on Debian install libopenscenegraph-dev.")
  elseif(NOT TARGET OpenGL::OpenGL)
    set(geofx_missing_osg "OpenGL was not found; on Debian install libopengl-dev.")
  else()
    add_library(osgGeoFX::OpenSceneGraph INTERFACE IMPORTED)
    target_include_directories(osgGeoFX::OpenSceneGraph SYSTEM INTERFACE ${OPENSCENEGRAPH_INCLUDE_DIRS})
    target_link_libraries(osgGeoFX::OpenSceneGraph INTERFACE ${OPENSCENEGRAPH_LIBRARIES} OpenGL::OpenGL)
  endif()
endif()
