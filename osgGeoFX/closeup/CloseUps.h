// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/closeup/CloseUp.h>
#include <osgGeoFX/closeup/SurfaceData.h>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/TextureUnits.h>

#include <memory>
#include <vector>

namespace osgGeoFX
{

/** Shows detail and overview together: regions of everything below the EffectScene are lifted, scaled and restyled
    above the overview, and an anchor ties each to its place. This is the system of Trapp and others, "Interactive
    close-ups for digital terrain models".

    @code
    osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    osg::ref_ptr<osgGeoFX::CloseUp> closeUp = new osgGeoFX::CloseUp;
    closeUp->getRegion()->setGeodeticCenter(longitude, latitude);   // radians
    closeUp->getRegion()->setSize(3000.0, 3000.0);                  // metres
    closeUp->setOffset(osg::Vec3d(0.0, 0.0, 4000.0));
    closeUps->addCloseUp(closeUp);
    scene->addEffect(closeUps);
    @endcode

    **What it draws.** The overview stays unchanged. Each close-up and each anchor is drawn into its own layer of a
    texture array, from the parts of the scene that its region touches. The layers are then drawn over the overview.
    Nearer layers cover farther ones, and objects in front of a layer hide it. If depthTest is off, the close-ups'
    order counts instead. Other effects of the scene, before or after this one, also appear in the close-ups: mappings
    and the painting of a panorama map show in them, its strokes too. Bends and panorama maps move them as rigid pieces. An
    exaggeration does not change their heights, which have a scale of their own (CloseUp::setScale()).

    **Pipelines.** SINGLE_PASS draws the objects in a region once, at the overview's level of detail. A geometry shader
    copies each triangle into the layers of the regions that it touches (paper: Section IV.A, SPFR). MULTI_PASS draws
    each close-up separately, at the level of detail that its size in the image needs (MPFR). Both draw the same image
    of the same geometry. AUTOMATIC uses SINGLE_PASS if the regions share most of the objects over them and no close-up
    could be more detailed than the overview, and MULTI_PASS otherwise. It decides by the camera's last frame. Objects
    that are not made of triangles, or that have their own shaders, and the strokes of a panorama map need MULTI_PASS, which
    then draws everything.

    **Frames.** World coordinates are those of EffectScene. Near and far planes are extended to contain the close-ups.

    **Limits.** The number of close-ups is unlimited. Each takes GPU memory in proportion to its size in the image. If
    the GPU has too few layers for SINGLE_PASS, MULTI_PASS draws, and one warning says so.

    **Threads.** A program changes a CloseUps between frames. Any number of cameras, views and contexts may draw it, in
    all threading models. Setters refuse values out of range: they return false, warn once and keep the former value.
    @ingroup closeup */
class OSGGEOFX_EXPORT CloseUps : public PassEffect, public TextureUser
{
public:
    CloseUps();
    CloseUps(const CloseUps& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, CloseUps);

    /// Adds a close-up. A null pointer and a close-up that was added before are refused with a warning. Without the
    /// depth test, the new close-up is drawn over all earlier ones.
    bool addCloseUp(CloseUp* closeUp);
    /// Returns false if the close-up is not in the list.
    bool removeCloseUp(CloseUp* closeUp);
    void removeCloseUps();
    unsigned int getNumCloseUps() const { return static_cast<unsigned int>(_closeUps.size()); }
    CloseUp* getCloseUp(unsigned int i) { return _closeUps[i].get(); }
    const CloseUp* getCloseUp(unsigned int i) const { return _closeUps[i].get(); }

    /// The source of the close-ups' surface layers. Null for none.
    bool setSurfaceData(SurfaceData* data);
    SurfaceData* getSurfaceData() { return _surfaceData.get(); }
    const SurfaceData* getSurfaceData() const { return _surfaceData.get(); }

    enum Pipeline
    {
        AUTOMATIC,
        SINGLE_PASS,
        MULTI_PASS
    };
    /// Default: AUTOMATIC.
    bool setPipeline(Pipeline pipeline) { return assign("pipeline", pipeline); }
    Pipeline getPipeline() const { return static_cast<Pipeline>(_pipeline); }
    /// The largest number of parts of a triangle's edge, 1…64. Tessellation acts where a mask changes or magnified
    /// ground is round, if the GPU has OpenGL 4. Stretched anchors and the borders of triangles are then as fine as
    /// the mask. 1 turns it off. Default: 16.
    bool setTessellation(int parts) { return assign("tessellation", parts); }
    int getTessellation() const { return _tessellation; }
    /// The opacity of all close-ups together, 0…1. Keys change it in a viewer. Default: 1.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// The number of samples along each side of a pixel in the layers, 1…4. The cost of smooth edges grows with its
    /// square. If the image would exceed the GPU's texture size, fewer samples are taken after a warning. Default: 1.
    bool setSupersampling(int samples) { return assign("supersampling", samples); }
    int getSupersampling() const { return _supersampling; }
    /// Whether objects in front hide close-ups and anchors. The paper draws them over everything. Default: true.
    bool setDepthTest(bool test) { return assign("depthTest", test ? 1.0 : 0.0); }
    bool getDepthTest() const { return _depthTest; }
    /// The largest number of layers of a texture array, 2…2048. The GPU may allow fewer. Default: 2048.
    bool setMaxLayers(int layers) { return assign("maxLayers", layers); }
    int getMaxLayers() const { return _maxLayers; }
    /// The texture units of the masks, tables and surface layers while the layers are drawn, 4…31, all different. With
    /// the default, −1, the scene chooses a unit: 11, 12 and 13 if they are free.
    bool setUnits(int masks, int tables, int surface)
    {
        return assign({{"maskUnit", masks}, {"tableUnit", tables}, {"surfaceUnit", surface}});
    }
    int getMaskUnit() const { return _maskUnit; }
    int getTableUnit() const { return _tableUnit; }
    int getSurfaceUnit() const { return _surfaceUnit; }
    /// The binding point of the uniform block, 0…35. With the default, −1, the scene chooses one: 7 if it is free.
    bool setBlockBinding(int binding) { return assign("blockBinding", binding); }
    int getBlockBinding() const { return _blockBinding; }

    /// Numbers about the last frame that a camera drew.
    struct Statistics
    {
        Pipeline pipeline = AUTOMATIC; ///< the pipeline that drew
        int closeUps = 0;              ///< number of close-ups in sight
        int layers = 0;                ///< layers of the texture array
        int width = 0, height = 0;     ///< size of a layer, texels
        int drawables = 0;             ///< drawables that the GPU got for all layers together
        bool tessellated = false;      ///< whether tessellation was on
    };
    Statistics statistics() const;

    const Properties& properties() const override;
    std::vector<TextureUnitWish> textureUnits() const override;
    std::vector<UniformBlockWish> uniformBlocks() const override
    {
        return {{"blockBinding", _blockBinding, 7}};
    }
    void cull(const ScenePass& pass) override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state) const override;

protected:
    ~CloseUps() override;
    std::string inconsistency() const override;

private:
    class Drawing;

    std::vector<osg::ref_ptr<CloseUp>> _closeUps;
    osg::ref_ptr<SurfaceData> _surfaceData;
    int _pipeline = AUTOMATIC;
    int _tessellation = 16;
    double _opacity = 1.0;
    int _supersampling = 1;
    bool _depthTest = true;
    int _maxLayers = 2048;
    int _maskUnit = -1, _tableUnit = -1, _surfaceUnit = -1, _blockBinding = -1;
    std::unique_ptr<Drawing> _drawing;
};

} // namespace osgGeoFX
