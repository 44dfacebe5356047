// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/Effect.h>

#include <osg/StateAttribute>
#include <osg/observer_ptr>

#include <vector>

namespace osgGeoFX
{

/** A part of the state that a scene draws with. When a graphics context closes in which it was applied, the effects
    release what they have in this context, wherever they are by then, and so do all programs of the kit.

    When a context closes, OSG releases the scene graphs of its cameras, and all textures and buffers. It leaves out an effect that
    was taken out of its scene, and a scene that is no longer in a view of this context. These would go on with programs and frame
    buffers whose names the next context gives to other objects. */
class ContextWatch : public osg::StateAttribute
{
public:
    /// OSG tells attributes apart by this number and by the member. It is the largest one that the type holds; OSG's own are smaller.
    static constexpr Type watchType = static_cast<Type>(127);

    ContextWatch() = default;
    explicit ContextWatch(const std::vector<osg::ref_ptr<Effect>>& effects);
    ContextWatch(const ContextWatch& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_StateAttribute(osgGeoFX, ContextWatch, watchType);

    /// Of two attributes of one type.
    unsigned int getMember() const override { return 0x67656f46; }
    int compare(const osg::StateAttribute& other) const override;
    void apply(osg::State& state) const override;

protected:
    ~ContextWatch() override;

private:
    std::vector<osg::observer_ptr<Effect>> _effects;
    bool _ofScene = false; ///< not one that OSG has made by itself
};

} // namespace osgGeoFX
