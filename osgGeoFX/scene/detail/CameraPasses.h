// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/scene/detail/PassCullVisitor.h>
#include <osgGeoFX/scene/detail/ProgramCache.h>

#include <map>
#include <utility>

namespace osgGeoFX
{

/** The visitors that cull the passes of one camera: one for each program, since what a visitor remembers of looks is for its program
    until the frame has been drawn; and others for those that a PassFilter guides. For one thread at a time. */
class CameraPasses
{
public:
    /// What was drawn in the last frame has been drawn.
    void startFrame(osgUtil::CullVisitor& outer);
    /// Changes with startFrame().
    unsigned int frame() const { return _frame; }

    /// The state of affairs of one traversal, in which passes are drawn: `task` is the scene's.
    void draw(osgUtil::CullVisitor& outer, osg::Group& scene, const CompensatingCullVisitor::Task& task,
              const ScenePass::Drawing& drawing);
    void draw(osgUtil::CullVisitor& outer, const std::vector<ScenePass::Piece>& pieces,
              const CompensatingCullVisitor::Task& task, const ScenePass::Drawing& drawing);

private:
    template<class Visitor>
    struct Known
    {
        osg::ref_ptr<osg::Program> program;
        osg::ref_ptr<Visitor> visitor;
        bool used = false;
    };
    template<class Visitor>
    using Visitors = std::map<const osg::Program*, Known<Visitor>>;

    template<class Visitor>
    static Visitor& of(Visitors<Visitor>& visitors, osg::Program* program, osgUtil::CullVisitor& outer);
    template<class Visitor>
    static void startFrame(Visitors<Visitor>& visitors, osgUtil::CullVisitor& outer);

    Visitors<CompensatingCullVisitor> _wholes;
    Visitors<PassCullVisitor> _parts;
    unsigned int _frame = 0;
};

/// The door for an effect's passes, in one traversal of one camera.
class CameraPass final : public ScenePass
{
public:
    struct Traversal
    {
        osgUtil::CullVisitor& outer;
        osg::Group& scene;
        const ViewGeometry& view;
        const CompensatingCullVisitor::Task& task; ///< of all passes, before they say what they draw
        CameraPasses& passes;
        ProgramCache& programs;
        const ProgramCache::Effects& effects;
    };
    CameraPass(const Traversal& traversal, const std::string& names, const std::vector<int>& textureUnits);

    osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const override;
    osg::ref_ptr<osg::Program> sceneProgram() const override;
    void draw(const Drawing& drawing) const override;
    void draw(const std::vector<Piece>& pieces, const Drawing& drawing) const override;

private:
    const Traversal& _traversal;
};

} // namespace osgGeoFX
