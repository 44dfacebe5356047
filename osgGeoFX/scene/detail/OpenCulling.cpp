// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/scene/detail/OpenCulling.h>

#include <osgGeoFX/scene/detail/CullVisitorAccess.h>

#include <algorithm>

namespace osgGeoFX
{

namespace
{

using Callback = osg::CullSettings::ClampProjectionMatrixCallback;

/// The depths of the near and the far plane of a projection, perspective or parallel.
template<typename Matrix>
void planesOf(const Matrix& projection, double& nearest, double& farthest)
{
    const osg::Matrixd inverse = osg::Matrixd::inverse(osg::Matrixd(projection));
    nearest = -(osg::Vec3d(0.0, 0.0, -1.0) * inverse).z();
    farthest = -(osg::Vec3d(0.0, 0.0, 1.0) * inverse).z();
}

unsigned int frameOf(const osgUtil::CullVisitor& visitor)
{
    return visitor.getFrameStamp() ? visitor.getFrameStamp()->getFrameNumber() : 0;
}

class KeepingCallback : public Callback
{
public:
    KeepingCallback(Callback* callback, osgUtil::CullVisitor& visitor, double nearest, double farthest)
        : host(callback), _visitor(visitor), _frame(frameOf(visitor)), _nearest(nearest), _farthest(farthest)
    {
    }
    bool clampProjectionMatrixImplementation(osg::Matrixf& projection, double& nearest,
                                             double& farthest) const override
    {
        return clamp(projection, nearest, farthest);
    }
    bool clampProjectionMatrixImplementation(osg::Matrixd& projection, double& nearest,
                                             double& farthest) const override
    {
        return clamp(projection, nearest, farthest);
    }
    /// Whether it was made for the frame that is on its way.
    bool current() const { return _frame == frameOf(_visitor); }
    void include(double nearest, double farthest)
    {
        _nearest = std::min(_nearest, nearest);
        _farthest = std::max(_farthest, farthest);
    }

    const osg::ref_ptr<Callback> host;

private:
    template<typename Matrix>
    bool clamp(Matrix& projection, double& nearest, double& farthest) const
    {
        if (!current()) return host->clampProjectionMatrixImplementation(projection, nearest, farthest);
        const Matrix before = projection;
        const double foundNear = nearest, foundFar = farthest;
        const bool done = host->clampProjectionMatrixImplementation(projection, nearest, farthest);
        double least = 0.0, most = 0.0;
        planesOf(projection, least, most);
        // A near plane in front of the eye cuts something off wherever the ground is close; the visitor's ratio decides.
        if (most >= _farthest && least <= std::max(_nearest, _farthest * _visitor.getNearFarRatio()))
            return done;
        projection = before;
        nearest = std::min(foundNear, _nearest);
        farthest = std::max(foundFar, _farthest);
        return _visitor.clampProjectionMatrixImplementation(projection, nearest, farthest);
    }

    osgUtil::CullVisitor& _visitor;
    const unsigned int _frame;
    double _nearest, _farthest;
};

} // namespace

void keepFromBeingCut(osgUtil::CullVisitor& visitor, double nearest, double farthest)
{
    // Not by the setter, after which the visitor would no longer take the camera's.
    osg::ref_ptr<Callback>& callback = CullVisitorAccess::clampCallback(visitor);
    if (!callback) return;
    auto* ours = dynamic_cast<KeepingCallback*>(callback.get());
    if (ours && ours->current())
    {
        ours->include(nearest, farthest);
        return;
    }
    const osg::ref_ptr<Callback> host = ours ? ours->host : callback;
    callback = new KeepingCallback(host, visitor, nearest, farthest);
}

} // namespace osgGeoFX
