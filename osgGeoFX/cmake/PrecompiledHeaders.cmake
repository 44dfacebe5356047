# Headers of others that most files include, read once for each group of targets: that is half of what compiling a file takes.
# -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without; lint.tidy reads each file by itself, so none may forget what it needs.
set(GEOFX_STANDARD_HEADERS
    <algorithm> <array> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <iostream> <limits>
    <map> <memory> <mutex> <optional> <random> <set> <sstream> <string> <thread> <unordered_map> <utility> <vector>)
set(GEOFX_SCENE_HEADERS
    <glm/glm.hpp>
    <osg/Camera> <osg/CoordinateSystemNode> <osg/Geode> <osg/Geometry> <osg/Image> <osg/LOD> <osg/LightSource>
    <osg/MatrixTransform> <osg/Notify> <osg/PagedLOD> <osg/Program> <osg/Texture2D> <osg/ValueObject>
    <osgDB/ReadFile> <osgUtil/CullVisitor> <osgViewer/Viewer>)
