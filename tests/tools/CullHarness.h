// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <tools/RandomSamples.h>

#include <osg/GraphicsContext>
#include <osg/Image>
#include <osg/Node>
#include <osg/PagedLOD>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgUtil/SceneView>

#include <set>
#include <string>
#include <vector>

namespace geofx::test
{

/// Takes down what nodes ask of the pager, and answers when it is told to.
class RequestRecorder : public osg::NodeVisitor::DatabaseRequestHandler
{
public:
    struct Request
    {
        std::string file;
        osg::PagedLOD* group;
        float priority;
        double time;        ///< reference time of the frame that asks, seconds
        unsigned int frame; ///< its number
    };

    void requestNodeFile(const std::string& file, osg::NodePath& path, float priority, const osg::FrameStamp*,
                         osg::ref_ptr<osg::Referenced>&, const osg::Referenced*) override;
    std::vector<Request> requests;
};

/// What one cull traversal left to be drawn.
struct Culled
{
    struct Leaf
    {
        osg::Drawable* drawable;
        osg::Matrixd modelView;
    };

    osg::ref_ptr<osg::Image> image;
    std::vector<Leaf> leaves;
    std::vector<RequestRecorder::Request> requests;
    osg::Matrixd projection; ///< after near and far were computed
    double seconds = 0.0;    ///< of the cull traversal

    std::set<const osg::Drawable*> drawables() const;
    std::set<const osg::PagedLOD*> requesting() const;
};

/// What a cull traversal must leave, by one without culling whose triangles were deformed one by one.
struct Oracle
{
    Oracle(const Culled& everything, const osgGeoFX::DeformationChain& chain);

    osg::ref_ptr<osg::Image> image;
    /// With at least one deformed triangle within the view volume's sides and before the eye.
    std::set<const osg::Drawable*> needed;
    /// Those that are in sight, or have a part in sight, and ask for more detail.
    std::set<const osg::PagedLOD*> deserving;

    struct Mistakes
    {
        bool picture = false; ///< differs in at least one bit
        int culled = 0;       ///< drawables in sight that are not drawn
        int unasked = 0;      ///< groups that deserve more detail and do not ask for it
    };
    Mistakes mistakesOf(const Culled& culled) const;
};

/** One scene view that is culled and drawn by hand, without a viewer or a pager's threads, so that two pictures of the
    same camera see the same tiles. */
class CullHarness
{
public:
    CullHarness(osg::GraphicsContext& context, osg::Node* scene, int width, int height);

    osg::Camera& camera() { return *_view->getCamera(); }
    /// Of the frame that setCamera() began.
    osg::FrameStamp& stamp() { return *_stamp; }
    /// What has been asked for since the last frame was begun.
    const std::vector<RequestRecorder::Request>& requests() const { return _recorder->requests; }
    void forgetRequests() { _recorder->requests.clear(); }
    void setScene(osg::Node* scene);
    void setCamera(const osg::Matrixd& view, const osg::Matrixd& projection);
    /// Culls, and draws where `draw` is set.
    Culled frame(bool cull, bool draw = true);

    /// Loads what was asked for, each with a probability.
    static int load(const std::vector<RequestRecorder::Request>& requests, Random& random,
                    double probability);

private:
    osg::ref_ptr<osg::GraphicsContext> _context;
    osg::ref_ptr<osgUtil::SceneView> _view;
    osg::ref_ptr<osg::FrameStamp> _stamp;
    osg::ref_ptr<RequestRecorder> _recorder = new RequestRecorder;
};

} // namespace geofx::test
