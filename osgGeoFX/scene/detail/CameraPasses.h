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

/** The visitors that cull the passes of one camera. Each program has a visitor of its own, because a visitor keeps
    the looks of its program until the frame has been drawn. Passes with a PassFilter have visitors of another class.
    For one thread at a time. */
class CameraPasses
{
public:
    /// Tells all visitors that the last frame has been drawn.
    void startFrame(osgUtil::CullVisitor& outer);
    /// The number of the frame; it grows with each startFrame().
    unsigned int frame() const { return _frame; }

    /// Draws a pass within one traversal. `task` is what the scene itself was culled with.
    void draw(osgUtil::CullVisitor& outer, const CompensatingCullVisitor::Task& task,
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

/// What an effect's passes use, in one traversal of one camera.
class CameraPass final : public ScenePass
{
public:
    struct Traversal
    {
        osgUtil::CullVisitor& outer;
        osg::Group& scene;
        const ViewGeometry& view;
        const CompensatingCullVisitor::Task&
            task; ///< what all passes start from, before they say what they draw
        CameraPasses& passes;
        ProgramCache& programs;
        const ProgramCache::Effects& effects;
        ShaderHost* shaderHost; ///< EffectScene::getShaderHost()
    };
    CameraPass(const Traversal& traversal, const std::string& names, const std::vector<int>& textureUnits,
               const std::vector<int>& blockBindings);

    osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const override;
    osg::ref_ptr<osg::Program> sceneProgram() const override;
    void draw(const Drawing& drawing) const override;
    void draw(const std::vector<Piece>& pieces, const Drawing& drawing) const override;

private:
    const Traversal& _traversal;
};

} // namespace osgGeoFX
