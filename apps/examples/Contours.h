// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An effect of one's own that colors surfaces: a contour line every so many metres of a projected terrain. Nothing here is part of
// the kit.
#pragma once

#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/SurfaceEffect.h>

class Contours : public osgGeoFX::SurfaceEffect
{
public:
    Contours()
    {
        osgGeoFX::ShaderLibrary::add(
            "example/contours.vert.glsl",
            "uniform vec4 SLOT_up; // and the eye's height\n"
            "out float SLOT_height;\n"
            "void SLOT_locate(vec3 p) { SLOT_height = dot(SLOT_up.xyz, p) + SLOT_up.w; }\n");
        osgGeoFX::ShaderLibrary::add(
            "example/contours.frag.glsl",
            "uniform float SLOT_step;\n"
            "in float SLOT_height;\n"
            "vec4 SLOT_color(vec4 color)\n{\n"
            "    float lines = SLOT_height / SLOT_step;\n"
            "    float step = fwidth(lines);\n"
            "    if (step < 1e-4) return color; // level ground has no line\n"
            "    float pixels = abs(fract(lines + 0.5) - 0.5) / step;\n"
            "    return vec4(mix(vec3(0.35, 0.15, 0.0), color.rgb, clamp(pixels, 0.0, 1.0)), "
            "color.a);\n}\n");
    }
    Contours(const Contours& other, const osg::CopyOp& copy) : SurfaceEffect(other, copy) {}
    META_Object(example, Contours);
    const osgGeoFX::Properties& properties() const override
    {
        static const osgGeoFX::Properties all = {enabledProperty()};
        return all;
    }
    std::string vertexFile() const override { return "example/contours.vert.glsl"; }
    std::string fragmentFile() const override { return "example/contours.frag.glsl"; }
    std::vector<osgGeoFX::Varying> varyings() const override { return {{"float", "height"}}; }

    bool fill(osg::StateSet& state, const std::string& prefix, const osgGeoFX::SurfaceView& view) override
    {
        state.getOrCreateUniform(prefix + "up", osg::Uniform::FLOAT_VEC4)
            ->set(osg::Vec4f(osg::Vec4d(view.geometry.up, view.geometry.eyeHeight)));
        state.getOrCreateUniform(prefix + "step", osg::Uniform::FLOAT)->set(100.0f);
        return true;
    }
};
