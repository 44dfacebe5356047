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

/** Detail and overview in one picture: regions of everything below the EffectScene, lifted out, scaled and re-styled
    above the overview, each tied to its place by an anchor. The system of Trapp and others, "Interactive close-ups for
    digital terrain models".

    @code
    osg::ref_ptr<osgGeoFX::CloseUps> closeUps = new osgGeoFX::CloseUps;
    osg::ref_ptr<osgGeoFX::CloseUp> closeUp = new osgGeoFX::CloseUp;
    closeUp->getRegion()->setGeodeticCentre(longitude, latitude);   // radians
    closeUp->getRegion()->setSize(3000.0, 3000.0);                  // metres
    closeUp->setOffset(osg::Vec3d(0.0, 0.0, 4000.0));
    closeUps->addCloseUp(closeUp);
    scene->addEffect(closeUps);
    @endcode

    **What it draws.** The overview stays as it is. Each close-up and each anchor is drawn into a layer of a texture array,
    from the parts of the scene that its region touches, and the layers are put over the overview: nearer ones over farther ones,
    hidden by what stands in front of them, or, where depthTest is off, in the close-ups' order. Effects that stand in the scene before and after it
    are in the close-ups, too: mappings show in them, bends move them as wholes.

    **Pipelines.** SINGLE_PASS draws what lies in a region once, as detailed as in the overview, and a geometry shader copies each
    triangle into the layers of those regions that it touches (paper: Section IV.A, SPFR). MULTI_PASS draws each close-up by itself,
    as detailed as its size in the picture asks for (MPFR). Both draw the same picture of the same geometry. AUTOMATIC takes
    SINGLE_PASS where regions share most of what lies over them and no close-up could be more detailed than the overview, and
    MULTI_PASS otherwise: it goes by the camera's last frame. What is not made of triangles or has shaders of its own needs
    MULTI_PASS, which then draws all of it.

    **Frames.** As EffectScene has them. Near and far planes come to contain the close-ups.

    **Limits.** Any number of close-ups; each takes some of the GPU's memory as large as it is in the picture. Where the GPU
    has too few layers for SINGLE_PASS, MULTI_PASS draws, and one warning says so.

    **Threads.** Changed between frames; any number of cameras, views and contexts draws it, in all threading models. */
class OSGGEOFX_EXPORT CloseUps : public PassEffect, public TextureUser
{
public:
    CloseUps();
    CloseUps(const CloseUps& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, CloseUps);

    /// Null and one that is there already are refused. Without the depth test it is drawn over those before it.
    bool addCloseUp(CloseUp* closeUp);
    bool removeCloseUp(CloseUp* closeUp);
    void removeCloseUps();
    unsigned int getNumCloseUps() const { return static_cast<unsigned int>(_closeUps.size()); }
    CloseUp* getCloseUp(unsigned int i) { return _closeUps[i].get(); }
    const CloseUp* getCloseUp(unsigned int i) const { return _closeUps[i].get(); }

    /// What the close-ups' surface layers are taken from; null for none.
    bool setSurfaceData(SurfaceData* data);
    SurfaceData* getSurfaceData() { return _surfaceData.get(); }
    const SurfaceData* getSurfaceData() const { return _surfaceData.get(); }

    enum Pipeline
    {
        AUTOMATIC,
        SINGLE_PASS,
        MULTI_PASS
    };
    /// AUTOMATIC by default.
    bool setPipeline(Pipeline pipeline) { return assign("pipeline", pipeline); }
    Pipeline getPipeline() const { return static_cast<Pipeline>(_pipeline); }
    /// Parts of a triangle's edge at most, 1…64, where a mask changes or round ground is magnified and the GPU has OpenGL 4: so
    /// stretched anchors and borders of triangles are as fine as the mask. 1 for none; 16 by default.
    bool setTessellation(int parts) { return assign("tessellation", parts); }
    int getTessellation() const { return _tessellation; }
    /// Of all close-ups together, 0…1; what keys turn. 1 by default.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// Samples along each side of a pixel in the layers, 1…4; smooth edges cost their square. 1 by default. Fewer, after a
    /// warning, where the picture would be larger than the GPU's textures.
    bool setSupersampling(int samples) { return assign("supersampling", samples); }
    int getSupersampling() const { return _supersampling; }
    /// Whether what stands in front hides close-ups and anchors. True by default; the paper draws them over everything.
    bool setDepthTest(bool test) { return assign("depthTest", test ? 1.0 : 0.0); }
    bool getDepthTest() const { return _depthTest; }
    /// Layers of a texture array at most, 2…2048: less where the GPU has less. 2048 by default.
    bool setMaxLayers(int layers) { return assign("maxLayers", layers); }
    int getMaxLayers() const { return _maxLayers; }
    /// Texture units of masks, tables and surface layers while the layers are drawn, 4…31, all different. −1, the default,
    /// leaves one to the scene, which gives 11, 12 and 13 where they are free.
    bool setUnits(int masks, int tables, int surface)
    {
        return assign({{"maskUnit", masks}, {"tableUnit", tables}, {"surfaceUnit", surface}});
    }
    int getMaskUnit() const { return _maskUnit; }
    int getTableUnit() const { return _tableUnit; }
    int getSurfaceUnit() const { return _surfaceUnit; }
    /// Binding point of the uniform block, 0…35. 7 by default.
    bool setBlockBinding(int binding) { return assign("blockBinding", binding); }
    int getBlockBinding() const { return _blockBinding; }

    /// What the last frame of some camera came to.
    struct Statistics
    {
        Pipeline pipeline = AUTOMATIC; ///< the one that drew
        int closeUps = 0;              ///< in sight
        int layers = 0;
        int width = 0, height = 0; ///< of a layer, texels
        int drawables = 0;         ///< handed to the GPU for all layers together
        bool tessellated = false;
    };
    Statistics statistics() const;

    const Properties& properties() const override;
    std::vector<TextureUnitWish> textureUnits() const override;
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
    int _maskUnit = -1, _tableUnit = -1, _surfaceUnit = -1, _blockBinding = 7;
    std::unique_ptr<Drawing> _drawing;
};

} // namespace osgGeoFX
