// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/ViewGeometry.h>
#include <osgGeoFX/paging/MemoryBudget.h>

#include <osg/AnimationPath>
#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/Group>
#include <osg/Matrixd>
#include <osg/Referenced>
#include <osgUtil/CullVisitor>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace osgGeoFX
{

class Effect;
class SceneDrawing;

/** Asks a pager for the tiles of where the cameras are going to be.

    @code
    scene->setPrefetch(new osgGeoFX::TilePrefetch);
    @endcode

    In each frame it looks at the scene from where each camera of the scene will be in some seconds, with the effects, the
    role, the lens and the LOD scale that the camera has now, and asks the camera's pager for what is missing there. Where that will be follows
    from the camera's last frames: its speed and its turn. Or the application says it (setPath()).

    **The present comes first.** What a camera lacks now keeps its priority, and the pager reads all of it before anything that is
    asked for ahead. Of that, what will be needed sooner comes first. A request goes on for half a second after
    the camera has changed its mind, so that a file on its way is not thrown away and fetched again.

    **What is there stays.** The pager does not expire tiles that will be needed. Their number has no limit but what there is to be
    seen within the lead; setBudget() gives one.

    A camera that stands still asks for nothing. One that jumps begins anew, and is known after three frames. It knows osg::PagedLOD
    and what derives from it, in both range modes; not engines with paging of their own, and not cameras below the scene.

    **Threads.** The scene calls it: while culling, in any of OSG's threading models and for any number of views, and in the update
    traversal, where no thread culls. There it looks ahead and asks. Call all functions between frames. If the scene is not in the graph, since
    an EffectCullCallback draws with it, call update() once in each frame, between the update traversal and culling.

    @ingroup scene */
class OSGGEOFX_EXPORT TilePrefetch : public osg::Referenced
{
public:
    /// Where a view's camera will be: the view matrix, from world coordinates to eye space, at a simulation time, seconds. Nothing
    /// where the path does not go; nothing is asked for there.
    using Path = std::function<std::optional<osg::Matrixd>(double time)>;

    TilePrefetch();

    /// How far it looks ahead, seconds, 0.1…60; at first 3. It should be longer than a few files take one after the other, for a
    /// level of detail is asked for when the coarser one is there.
    void setLead(double seconds);
    double getLead() const;

    /// Tells where a view's camera goes. `camera`: the view's own; null for those of all views. Slaves whose matrices are relative
    /// to their view's follow it; of all other cameras, and without a path or with an empty one, motion tells. The path is asked in
    /// the update traversal, and must not call this object.
    void setPath(Path path, const osg::Camera* camera = nullptr);
    /// The path of an osg::AnimationPath, which begins at a simulation time. One that does not loop ends with its last point.
    static Path along(const osg::AnimationPath& path, double start = 0.0);

    /// Asks for nothing new while the memory has no room, and looks less far ahead after tiles had to go that it had asked for. Null,
    /// the default: the memory has no limit.
    void setBudget(MemoryBudget* budget);

    /// Totals, and figures of the last frame.
    struct Counts
    {
        std::uint64_t asked = 0;   ///< children that were asked for ahead
        unsigned int waiting = 0;  ///< of them, those that have not come yet
        unsigned int cameras = 0;  ///< that were looked ahead for
        double milliseconds = 0.0; ///< that this took
        double lead = 0.0;         ///< seconds; shorter than getLead() where the memory wants it
    };
    Counts counts() const;

    /// Looks ahead and asks; the second call within a frame does nothing.
    void update(const osg::FrameStamp& stamp);

protected:
    ~TilePrefetch() override;

private:
    friend class SceneDrawing;
    using Effects = std::vector<osg::ref_ptr<Effect>>;
    /// A camera culls the scene. `effects`: those that it draws; `compensates`: whether the kit's visitor culls.
    void note(osgUtil::CullVisitor& outer, osg::Group& top, const ViewGeometry& view, const Effects& effects,
              bool compensates);

    struct Parts;
    std::unique_ptr<Parts> _parts;
};

} // namespace osgGeoFX
