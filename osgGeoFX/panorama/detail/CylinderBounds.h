// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GlslFunctions.h>

namespace osgGeoFX
{

/// Bounds of the functions of shaders/lib/cylinder.glsl over a circle of the ground. If there is no cylinder, those of the
/// identity.
struct CylinderBounds
{
    /// `ground`: the circle's center, (x, s) from the eye's foot; `reach`: its radius; metres.
    CylinderBounds(const glsl::geofx_Cylinder& view, const glm::dvec2& ground, double reach);

    double sideReach;           ///< of x on the cylinder, metres
    double sideStretch = 1.0;   ///< of x for each metre of the ground
    double sideCurvature = 0.0; ///< of x: second derivative, 1/metre
    double curvature = 0.0;     ///< of s, 1/metre
    double width = 1.0;         ///< the scale of widths, at most
    double widthRate = 0.0;     ///< its derivative by s, 1/metre
    double widthSecond = 0.0;   ///< 1/metre²
    double widthKink = 0.0;     ///< the jump of the derivative at the picture's base, 1/metre
    double shownRate = 0.0; ///< of the share of its depth that a place keeps, for each metre of the ground
    double turned = 0.0;    ///< the least angle from the middle of the part that is drawn, radians
    /// Whether it reaches to where places are kept out of the picture. Second derivatives are unknown there.
    bool leavesPicture = false;
    bool belowEye = false; ///< whether all of it lies below the eye, where nothing is drawn
};

} // namespace osgGeoFX
