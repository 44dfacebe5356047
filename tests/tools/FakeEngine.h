// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osg/CullSettings>
#include <osg/CullStack>
#include <osg/Geometry>
#include <osg/Group>
#include <osgGeoFX/scene/EngineTiles.h>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <vector>

namespace geofx::test
{

/** A terrain engine that culls for itself, as osgEarth's does: by a culling stack that it makes of the visitor's mode,
    projection and matrix, by a horizon, and by distances that it asks the visitor for. Its tiles stand around the
    origin, z up. */
class FakeEngine : public osg::Group
{
public:
    /// `cells` × `cells` tiles, cut out of a ground; the coarse ones are drawn beyond `range`, metres.
    struct Tile
    {
        osg::ref_ptr<osg::Geometry> fine, coarse;
    };
    FakeEngine(std::vector<Tile> tiles, double range) : _tiles(std::move(tiles)), _range(range)
    {
        for (const Tile& tile : _tiles)
        {
            addChild(tile.fine);
            addChild(tile.coarse);
        }
    }

    bool culls = true;      ///< false: it draws all tiles
    bool horizon = true;    ///< whether its planet is so small that it leaves out what is beyond the horizon
    bool asks = false;      ///< whether it draws coarse what the kit says is out of sight
    bool leavesOut = false; ///< whether it does not draw what the kit says is out of sight by its box
    int fine = 0;           ///< fine tiles in all traversals of the last frame
    int drawn = 0;          ///< tiles in all traversals of the last frame
    osg::Vec3d viewPoint;   ///< of the last traversal
    int kept = 0;           ///< those of which the visitor draws something

    void traverse(osg::NodeVisitor& visitor) override
    {
        osgUtil::CullVisitor* const cull = visitor.asCullVisitor();
        if (!cull)
        {
            osg::Group::traverse(visitor);
            return;
        }
        osg::CullStack stack;
        stack.setCullingMode(cull->getCullingMode());
        stack.pushViewport(cull->getViewport());
        stack.pushProjectionMatrix(new osg::RefMatrix(*cull->getProjectionMatrix()));
        stack.pushModelViewMatrix(new osg::RefMatrix(*cull->getModelViewMatrix()),
                                  osg::Transform::ABSOLUTE_RF);
        const osg::Vec3d eye = cull->getViewPointLocal();
        viewPoint = eye;
        if (const unsigned int frame = cull->getFrameStamp()->getFrameNumber(); frame != _frame)
        {
            _frame = frame;
            drawn = kept = fine = 0;
        }
        for (const Tile& tile : _tiles)
        {
            const osg::BoundingBox& box = tile.fine->getBoundingBox();
            if (culls && (stack.isCulled(box) || (horizon && belowHorizon(eye, box)))) continue;
            if (leavesOut && osgGeoFX::isBoxOutOfSight(box, osg::Matrixd(), visitor)) continue;
            ++drawn;
            const bool near = cull->getDistanceToViewPoint(box.center(), true) < static_cast<float>(_range) &&
                              !(asks && osgGeoFX::isTileOutOfSight(*tile.fine, visitor));
            fine += near ? 1 : 0;
            const unsigned int before = leavesIn(*cull->getCurrentRenderBin());
            (near ? tile.fine : tile.coarse)->accept(visitor);
            if (leavesIn(*cull->getCurrentRenderBin()) > before) ++kept;
        }
        stack.popModelViewMatrix();
        stack.popProjectionMatrix();
        stack.popViewport();
    }

private:
    static unsigned int leavesIn(const osgUtil::RenderBin& bin)
    {
        std::size_t count = 0;
        for (const osgUtil::StateGraph* graph : const_cast<osgUtil::RenderBin&>(bin).getStateGraphList())
            count += graph->_leaves.size();
        return static_cast<unsigned int>(count);
    }
    /// On a planet that is small enough for this to matter.
    static bool belowHorizon(const osg::Vec3d& eye, const osg::BoundingBox& box)
    {
        const osg::Vec3d way = osg::Vec3d(box.center()) - eye;
        return osg::Vec2d(way.x(), way.y()).length() > 1.5 * std::max(eye.z(), 1.0);
    }

    const std::vector<Tile> _tiles;
    const double _range;
    unsigned int _frame = 0;
};

/// Clamps the far plane to the horizon of a FakeEngine, as hosts do that know it.
class FakeClamp : public osg::CullSettings::ClampProjectionMatrixCallback
{
public:
    FakeClamp(osgUtil::CullVisitor& visitor, double farthest) : _visitor(visitor), _farthest(farthest) {}
    bool clampProjectionMatrixImplementation(osg::Matrixf& projection, double& near,
                                             double& far) const override
    {
        far = std::min(far, _farthest);
        return _visitor.clampProjectionMatrixImplementation(projection, near, far);
    }
    bool clampProjectionMatrixImplementation(osg::Matrixd& projection, double& near,
                                             double& far) const override
    {
        far = std::min(far, _farthest);
        return _visitor.clampProjectionMatrixImplementation(projection, near, far);
    }

private:
    osgUtil::CullVisitor& _visitor;
    const double _farthest;
};

} // namespace geofx::test
