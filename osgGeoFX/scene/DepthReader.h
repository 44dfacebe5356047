// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DepthConvention.h>

#include <osg/Camera>
#include <osg/Drawable>
#include <osg/Matrixd>
#include <osg/Vec2d>
#include <osg/Vec3d>

#include <memory>
#include <vector>

namespace osgGeoFX
{

/// The depths of a frame that has been drawn, and the matrices that it was drawn with. A plain value.
/// @ingroup scene
struct OSGGEOFX_EXPORT DepthPicture
{
    unsigned int frame = 0; ///< OSG's frame number
    int width = 0;          ///< of the camera's viewport, pixels
    int height = 0;
    /// Window depths, 0…1, row by row from the lowest one. Empty where they could not be read; then nothing counts as hidden.
    std::vector<float> depths;
    osg::Matrixd view;       ///< from world to eye coordinates
    osg::Matrixd projection; ///< with the near and far planes of the frame
    bool zeroToOne = false;  ///< whether clip space has depths of 0…1 (glClipControl)
    DepthConvention convention;

    /** Whether a place in eye space is to be seen: whether at its pixel, or at one of those around it, nothing was drawn
        that is nearer by more than a share of the distance. A place outside the picture or behind the eye is not to be seen.
        `around`: pixels. */
    bool shows(const osg::Vec3d& eye, int around = 1, double tolerance = 0.004) const;
};

/** Reads the depths of the frames that are drawn, for programs that must know whether a place is hidden: labels, markers, lights.

    Add it to the graph of the cameras concerned, outside of EffectScenes and transforms. It reads when all else of the camera's
    own stage has been drawn. The picture of a frame is there when a later frame is drawn, or at once where the reader is
    immediate. Reading into a buffer does not wait for the GPU. Multisampled targets are resolved first.

    Files do not keep it.

    Threads: any thread may ask for pictures.
    @ingroup scene */
class OSGGEOFX_EXPORT DepthReader : public osg::Drawable
{
public:
    DepthReader();
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "DepthReader"; }

    /// Whether a frame's depths are there as soon as it has been drawn. It makes the CPU wait for the GPU. False by default.
    void setImmediate(bool on) { _immediate = on; }
    bool isImmediate() const { return _immediate; }
    /// Depths of every n-th frame are read, 1…1,000; 1 by default. Call it between frames.
    void setInterval(unsigned int frames);
    unsigned int getInterval() const { return _interval; }
    /// What the application writes as depth, as EffectScene::setDepthConvention() has it.
    void setDepthConvention(const DepthConvention& convention) { _convention = convention; }

    /// The newest picture of a camera; null if there is none yet.
    std::shared_ptr<const DepthPicture> picture(const osg::Camera& camera) const;
    /// The newest picture of each camera; empty if there is none yet.
    std::vector<std::shared_ptr<const DepthPicture>> pictures() const;

    void drawImplementation(osg::RenderInfo& renderInfo) const override;
    osg::BoundingBox computeBoundingBox() const override { return {}; }
    osg::BoundingSphere computeBound() const override { return {}; }
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~DepthReader() override;

private:
    struct Shared;
    bool _immediate = false;
    unsigned int _interval = 1;
    DepthConvention _convention;
    std::unique_ptr<Shared> _shared;
};

} // namespace osgGeoFX
