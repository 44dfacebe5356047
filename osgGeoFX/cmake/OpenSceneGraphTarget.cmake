# Debian's OpenSceneGraph 3.6.5 ships no CMake package; CMake's own module finds it, without targets.
# This wraps what it finds into one imported target, for our build and, installed, for a consumer's.
if(NOT TARGET osgGeoFX::OpenSceneGraph)
  find_package(OpenSceneGraph 3.6.5 QUIET MODULE COMPONENTS osgDB osgGA osgText osgUtil osgViewer osgTerrain)
  if(NOT OPENSCENEGRAPH_FOUND)
    message(FATAL_ERROR "OpenSceneGraph 3.6.5 or newer was not found; on Debian install libopenscenegraph-dev.")
  endif()
  find_package(OpenGL REQUIRED COMPONENTS OpenGL EGL)
  add_library(osgGeoFX::OpenSceneGraph INTERFACE IMPORTED)
  target_include_directories(osgGeoFX::OpenSceneGraph SYSTEM INTERFACE ${OPENSCENEGRAPH_INCLUDE_DIRS})
  target_link_libraries(osgGeoFX::OpenSceneGraph INTERFACE ${OPENSCENEGRAPH_LIBRARIES} OpenGL::OpenGL)
endif()
