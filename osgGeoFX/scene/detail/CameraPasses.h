// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/ScenePass.h>
#include <osgGeoFX/scene/detail/PassCullVisitor.h>
#include <osgGeoFX/scene/detail/ProgramCache.h>

#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class PassEffect;

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
    /// An effect that draws passes for this camera, and what it has of the scene's.
    struct Drawer
    {
        PassEffect* effect;
        std::string prefix;
        const std::vector<int>& units;
        const std::vector<int>& blocks;
    };
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
        std::vector<Drawer> drawers;
    };
    /// `within`: the pass of another effect in which a companion is drawn; it must live as long. Null for none.
    struct Within
    {
        std::shared_ptr<const PassShaders> shaders;
        const std::string& prefix;
    };
    CameraPass(const Traversal& traversal, const Drawer& drawer, const Within* within = nullptr);

    osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const override;
    osg::ref_ptr<osg::Program> sceneProgram() const override;
    std::vector<DrawableCompanion*> companions(const PassShaders& shaders) const override;
    const std::string* within() const override { return _within ? &_within->prefix : nullptr; }
    void draw(const Drawing& drawing) const override;
    void draw(const std::vector<Piece>& pieces, const Drawing& drawing) const override;

private:
    const Traversal& _traversal;
    const Within* const _within;
};

} // namespace osgGeoFX
