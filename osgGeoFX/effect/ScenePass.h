// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/effect/DepthConvention.h>
#include <osgGeoFX/effect/Effect.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <osg/Drawable>
#include <osg/Group>
#include <osg/Program>
#include <osg/StateSet>
#include <osgUtil/CullVisitor>
#include <osgUtil/RenderStage>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace osgGeoFX
{

class DrawableCompanion;
class PassFilter;

/** The shader files of an effect that draws the scene again. `SLOT_` in them stands for the effect's prefix.

    - Vertex files have `vec3 SLOT_move(vec3 located, vec3 bent)`, which returns where a point goes, in eye space.
      `located` is its undeformed place; `bent` is the place that the scene's deformations give it. Without vertex
      files all points go to `bent`.
    - Fragment files have `vec4 SLOT_finish(vec4 color)`, which returns the final color, `int SLOT_channels()`,
      which returns the channels of the mappings to show, as bits, and `vec2 SLOT_pixel(vec2 pixel)`, which returns
      where a pixel of the pass' target is in the camera's window. Without fragment files the colors stay.
    - Geometry files have main(). The vertex and the fragment files then see the define GEOFX_AMPLIFY. In geometry
      files, GEOFX_VARYINGS stands for the declarations of all variables that the other effects hand to the fragment
      stage. GEOFX_COPY(i) hands on the values of vertex i.
    - Tessellation files need geometry files, too. The vertex files then also see GEOFX_TESSELLATE.
      GEOFX_COPY(gl_InvocationID) hands on the values in control files, and GEOFX_COPY(w) in evaluation files,
      weighted by w.

    @ingroup effect */
struct PassShaders
{
    std::vector<std::string> vertex, tessellationControl, tessellationEvaluation, geometry, fragment;
    /// The files with main() of the vertex and the fragment stage. Where they are empty, the kit's replacement of the
    /// fixed functions is used.
    std::string vertexMain, fragmentMain;
    std::vector<std::pair<std::string, unsigned int>>
        blocks; ///< uniform blocks: names without the prefix, and binding points (ScenePass::blocks)
    /// What the vertex files hand to the fragment files where there are no stages between them. Other effects need it to draw
    /// their companions in this pass.
    std::vector<Varying> varyings;
    /// The pass of another effect in which this one is drawn (ScenePass::companions()), with that effect's prefix. This
    /// one has the mains and the geometry stage; the other one moves the points and finishes the colors.
    std::shared_ptr<const PassShaders> within;
    std::string withinPrefix;
};

/** The interface through which an effect draws the scene again. It tells what one culling camera knows, and it
    draws.

    The EffectScene makes an object for each call of PassEffect::cull() and PassEffect::companion(). The object lives
    as long as the call.

    @ingroup effect */
class OSGGEOFX_EXPORT ScenePass
{
public:
    osgUtil::CullVisitor&
        outer; ///< the camera's, at the EffectScene: for viewports, matrices, and the effect's own drawables
    osg::Group& scene; ///< the EffectScene
    const ViewGeometry& view;
    const DeformationChain& chain;  ///< the deformations of this camera
    osg::StateSet& state;           ///< the uniforms and defines of all effects for this camera
    const std::string& prefix;      ///< the prefix of the effect's uniforms and defines
    const std::vector<int>& units;  ///< the effect's texture units (TextureUser)
    const std::vector<int>& blocks; ///< the binding points of its uniform blocks (TextureUser)
    /// Which of two depths is the nearer one for this camera. `state` has what shaders need; state sets that are not below it
    /// get it by CameraDepth::put().
    const CameraDepth& depth;
    /// The format of color textures that lose nothing of what the camera draws into: GL_RGBA8, or one with 16 bits or with
    /// floats. In the last two, shaders see the define GEOFX_HDR: colors may be above 1.
    GLenum colorFormat;
    bool compensate; ///< EffectScene::getCompensation()
    /// Changes when the camera begins a new frame. If it differs from the last time, the former frame has been drawn,
    /// and the objects that it was drawn with may be used again. A camera may call several times in one frame.
    unsigned int frame;

    virtual ~ScenePass();

    /// A program of all effects with the pass' own shaders. It stays the same until effects or shaders change. Null,
    /// after a warning, if a shader file is missing.
    virtual osg::ref_ptr<osg::Program> program(const PassShaders& shaders) const = 0;
    /// The program that the scene itself is drawn with.
    virtual osg::ref_ptr<osg::Program> sceneProgram() const = 0;
    /// What the other effects draw together with the scene's drawables, drawn as a pass of this effect with these shaders,
    /// which must have vertex and fragment files alone. For Drawing::companions.
    virtual std::vector<DrawableCompanion*> companions(const PassShaders& shaders) const = 0;
    /// Of a companion in the pass of another effect: that effect's prefix. Null in the scene's own image.
    virtual const std::string* within() const { return nullptr; }

    /// What part of the scene to draw again, how, and where to.
    struct Drawing
    {
        osg::Program* program = nullptr; ///< for drawables without a program of their own
        osg::StateSet* state = nullptr;  ///< below `state` of the ScenePass; null for none
        /// A render stage of the effect; null for the one that the camera draws into.
        osgUtil::RenderStage* stage = nullptr;
        const DeformationChain* chain = nullptr; ///< replaces the camera's chain; null keeps it
        /// Selects the parts to draw; null for everything in sight. With a filter, neither the borders of the image nor
        /// the near and far planes cull, and cameras below the scene are left out. A filter that returns no states only
        /// looks at the scene and draws nothing.
        PassFilter* filter = nullptr;
        /// Whether the pass has the image of the view's own camera, although another one may draw a part of it, or see it
        /// from elsewhere (ViewGeometry::image). Its state needs the define GEOFX_IMAGE, OFF with OVERRIDE.
        bool ofView = false;
        /// Companions of the drawables that a filter chooses, drawn with their states; null for none.
        const std::vector<DrawableCompanion*>* companions = nullptr;
        /// Whether pagers are asked for tiles that the pass lacks. Without, it draws what is there, and what it draws does not
        /// count as seen: a pager, or a MemoryBudget, removes tiles that nobody else draws.
        bool asksForTiles = true;
    };
    /** Culls the scene again and draws what it finds. Compensation, paging and levels of detail are as for the scene
        itself. Near and far planes stay as they are. Everything that is passed must live until the frame has been
        drawn. */
    virtual void draw(const Drawing& drawing) const = 0;

    /// A drawable of the effect's own.
    struct Piece
    {
        osg::Drawable* drawable = nullptr;
        osg::Matrixd modelView;         ///< from the frame of the drawable to eye space
        osg::StateSet* state = nullptr; ///< below the drawing's; null for none
    };
    /// Draws pieces instead of the scene. Nothing culls them. `drawing` must have no filter.
    virtual void draw(const std::vector<Piece>& pieces, const Drawing& drawing) const = 0;

protected:
    ScenePass(osgUtil::CullVisitor& visitor, osg::Group& group, const ViewGeometry& geometry,
              const DeformationChain& deformations, osg::StateSet& stateSet, const std::string& names,
              const std::vector<int>& textureUnits, const std::vector<int>& blockBindings,
              const CameraDepth& cameraDepth, GLenum format, bool compensation, unsigned int number)
        : outer(visitor), scene(group), view(geometry), chain(deformations), state(stateSet), prefix(names),
          units(textureUnits), blocks(blockBindings), depth(cameraDepth), colorFormat(format),
          compensate(compensation), frame(number)
    {
    }
};

} // namespace osgGeoFX
