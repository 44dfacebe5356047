// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An effect of one's own that draws parts of the scene again: an outline around what is selected. Nothing here is part of the kit.
#pragma once

#include <osg/CullFace>
#include <osg/LineWidth>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osgGeoFX/effect/PassEffect.h>
#include <osgGeoFX/effect/PassFilter.h>
#include <osgGeoFX/effect/ShaderLibrary.h>

class Outline : public osgGeoFX::PassEffect
{
public:
    Outline()
    {
        osgGeoFX::ShaderLibrary::add("example/outline.glsl",
                                     "vec4 SLOT_finish(vec4 color) { return vec4(1.0, 0.55, 0.0, 1.0); }\n"
                                     "int SLOT_channels() { return 0; }\n"
                                     "vec2 SLOT_pixel(vec2 pixel) { return pixel; }\n");
        // The faces that look away, as thick lines: what stands out from behind the object is its outline.
        const auto on =
            osg::StateAttribute::ON | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED;
        _lines->setAttributeAndModes(new osg::CullFace(osg::CullFace::FRONT), on);
        _lines->setAttributeAndModes(
            new osg::PolygonMode(osg::PolygonMode::FRONT_AND_BACK, osg::PolygonMode::LINE), on);
        _lines->setAttributeAndModes(new osg::LineWidth(6.0f), on);
        // Behind the faces that look this way, with which they share edges.
        _lines->setAttributeAndModes(new osg::PolygonOffset(2.0f, 4.0f), on);
    }
    Outline(const Outline& other, const osg::CopyOp& copy)
        : PassEffect(other, copy), _lines(other._lines), _selected(other._selected)
    {
    }
    META_Object(example, Outline);
    const osgGeoFX::Properties& properties() const override
    {
        static const osgGeoFX::Properties all = {enabledProperty()};
        return all;
    }

    /// Null for nothing.
    void select(const osg::Drawable* drawable) { _selected = drawable; }

    void cull(const osgGeoFX::ScenePass& pass) override
    {
        if (!_selected) return;
        osgGeoFX::PassShaders shaders;
        shaders.fragment = {"example/outline.glsl"};
        Selection selection(_selected, _lines);
        pass.draw({pass.program(shaders), nullptr, nullptr, nullptr, &selection});
    }

private:
    struct Selection final : public osgGeoFX::PassFilter
    {
        Selection(const osg::Drawable* drawable, osg::StateSet* lines) : wanted(drawable), drawn({lines}) {}
        bool outside(const osgGeoFX::Ball&) const override { return false; }
        const std::vector<osg::StateSet*>& states(const osg::Drawable& drawable, const osgGeoFX::EyeBox&,
                                                  const osg::Matrixd&, bool) override
        {
            return &drawable == wanted ? drawn : none;
        }
        const osg::Drawable* wanted;
        const std::vector<osg::StateSet*> drawn, none;
    };

    osg::ref_ptr<osg::StateSet> _lines = new osg::StateSet;
    osg::ref_ptr<const osg::Drawable> _selected;
};
