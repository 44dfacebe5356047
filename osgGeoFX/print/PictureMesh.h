// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Matrixd>
#include <osg/Node>

#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

struct MeshPiece;

/** The terrain as one picture shows it, as a mesh that is deformed: seen from the picture's camera, without any effect, it has the same outlines.

    It has the tiles that are loaded, at the levels of detail of the camera, and what of their triangles lies in the picture. Vertices are moved as the GPU
    moves them, and normals turn with them. Triangles that have a corner behind the eye, or one that cannot be moved, are left out. Texture coordinates and textures are
    those of the tiles (unit 0). What effects paint, and strokes, are not in it: the layers of the picture are (PictureLayers).

    Coordinates are local, metres, x east, y north, z up, so that floats are exact; frame() tells where that is.

    Make it where the scene graph may be read; afterwards it does not change.
    @ingroup print */
class OSGGEOFXMAPS_EXPORT PictureMesh
{
public:
    /// `camera`: of the whole picture that was drawn last, with its viewport (SceneRenderer::camera()). `reference`: null if the
    /// scene has none; then the local axes are those of the world.
    PictureMesh(EffectScene& scene, const osg::Camera& camera, const Georeference* reference);

    std::size_t triangles() const; ///< how many there are
    /// From local coordinates to the scene's world.
    const osg::Matrixd& frame() const { return _frame; }
    /// From local coordinates to eye space; with the camera's projection it gives the picture's outlines.
    osg::Matrixd view() const { return _frame * _modelView; }
    /// The mesh in local coordinates. User values: `geofx.frame` and `geofx.view` (the two matrices), `geofx.projection`.
    osg::ref_ptr<osg::Node> node() const;

    /** Writes the mesh by the file's extension. `.obj`: y is up there, as usual in this format; a comment tells the frame and the camera. Materials
        are in the `.mtl` file beside it, and textures in the folder `NAME.textures`. `.osgb` has its textures within. False, with a
        sentence in `error`, if it cannot be written. */
    bool write(const std::string& file, std::string& error) const;
    /// Why a mesh cannot be written to a file of this name, as a sentence; empty if it probably can.
    static std::string faultOf(const std::string& file);

private:
    class Collector;

    void collect(EffectScene& scene, const DeformationChain& chain, const osg::Matrixd& clip,
                 double lodScale);
    void settle(const Georeference* reference);

    std::shared_ptr<std::vector<MeshPiece>> _pieces;
    osg::Matrixd _frame;
    osg::Matrixd _modelView; ///< from the scene's world to eye space
    osg::Matrixd _projection;
};

} // namespace osgGeoFX
