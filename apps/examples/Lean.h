// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A deformation of one's own: what is high leans to the right, over a projected terrain. Nothing here is part of the kit.
#pragma once

#include <osgGeoFX/effect/Deformation.h>
#include <osgGeoFX/effect/ShaderLibrary.h>
#include <osgGeoFX/effect/ViewGeometry.h>

#include <cmath>

/// position + slope · height · right: an affine map, of which culling, picking and levels of detail learn all from these.
class LeanSnapshot : public osgGeoFX::DeformationSnapshot
{
public:
    LeanSnapshot(const osgGeoFX::ViewGeometry& view, double slope)
        : _up(view.up), _eyeHeight(view.eyeHeight), _right(osg::Vec3d(1, 0, 0) - view.up * view.up.x())
    {
        _right *= slope;
    }
    osg::Vec3d deform(const osg::Vec3d& p) const override { return p + _right * (_up * p + _eyeHeight); }
    osg::Vec3d undeform(const osg::Vec3d& p) const override { return p - _right * (_up * p + _eyeHeight); }
    osg::Vec3d deformNormal(const osg::Vec3d&, const osg::Vec3d& normal) const override
    {
        osg::Vec3d result = normal - _up * (_right * normal);
        result.normalize();
        return result;
    }
    Reach reach(const osgGeoFX::Ball&) const override { return Reach::Affine; }
    double lipschitz(const osgGeoFX::Ball&) const override { return 1.0 + _right.length(); }
    Uniforms uniforms() const override
    {
        return {{"up", osg::Vec4d(_up, _eyeHeight)}, {"right", osg::Vec4d(_right, 0.0)}};
    }

private:
    osg::Vec3d _up;
    double _eyeHeight;
    osg::Vec3d _right; ///< horizontal
};

class Lean : public osgGeoFX::Deformation
{
public:
    Lean()
    {
        osgGeoFX::ShaderLibrary::add(
            "example/lean.glsl",
            "uniform vec4 SLOT_up, SLOT_right;\n"
            "vec3 SLOT_deform(vec3 p) { return p + SLOT_right.xyz * (dot(SLOT_up.xyz, p) + SLOT_up.w); }\n"
            "vec3 SLOT_normal(vec3 p, vec3 n) { return normalize(n - SLOT_up.xyz * dot(SLOT_right.xyz, n)); "
            "}\n"
            "float SLOT_style(vec3 p) { return 0.0; }\n");
    }
    Lean(const Lean& other, const osg::CopyOp& copy) : Deformation(other, copy) {}
    META_Object(example, Lean);
    const osgGeoFX::Properties& properties() const override
    {
        static const osgGeoFX::Properties all = {enabledProperty()};
        return all;
    }
    osg::ref_ptr<const osgGeoFX::DeformationSnapshot>
    snapshot(const osgGeoFX::ViewGeometry& view) const override
    {
        return new LeanSnapshot(view, 0.5);
    }
    std::string vertexFile() const override { return "example/lean.glsl"; }
};
