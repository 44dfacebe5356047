// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <gtest/gtest.h>
#include <osg/ClipControl>
#include <osg/Depth>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/HostPrograms.h>

#include <cmath>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace geofx::test
{

/** The depths that applications draw with. Each sets up a camera that has a standard projection, its scene, and what the
    application draws itself, so that every kind should give one and the same picture. */
struct DepthKind
{
    enum Projection
    {
        STANDARD,
        REVERSED,         ///< near 1, far 0
        REVERSED_INFINITE ///< near 1, infinity 0
    };
    const char* name;
    Projection projection = STANDARD;
    bool clipControl = false; ///< glClipControl(GL_ZERO_TO_ONE)
    osgGeoFX::DepthConvention::Kind convention = osgGeoFX::DepthConvention::OF_PROJECTION;

    static const std::vector<DepthKind>& all()
    {
        using Convention = osgGeoFX::DepthConvention;
        static const std::vector<DepthKind> kinds = {
            {"reversed", REVERSED, true},
            {"reversedInfinite", REVERSED_INFINITE, true},
            {"reversedWithoutClipControl", REVERSED},
            {"reversedInfiniteWithoutClipControl", REVERSED_INFINITE},
            {"logarithmic", STANDARD, false, Convention::LOGARITHMIC},
            {"logarithmicByFragment", STANDARD, false, Convention::LOGARITHMIC_BY_FRAGMENT}};
        return kinds;
    }

    bool logarithmic() const { return convention != osgGeoFX::DepthConvention::OF_PROJECTION; }
    static constexpr double farDistance = 1e7; ///< of logarithmic depths, metres; not the projection's

    /// From clip coordinates of a standard projection: depths 1 to −1 become 0 to 1.
    static osg::Matrixd reversal()
    {
        osg::Matrixd reversal;
        reversal(2, 2) = -0.5;
        reversal(3, 2) = 0.5;
        return reversal;
    }

    void setUp(osg::Camera& camera, osgGeoFX::EffectScene& scene) const
    {
        osg::StateSet& state = *camera.getOrCreateStateSet();
        if (projection != STANDARD)
        {
            osg::Matrixd matrix = camera.getProjectionMatrix() * reversal();
            if (projection == REVERSED_INFINITE)
            {
                double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0, nearest = 0.0, farthest = 0.0;
                ASSERT_TRUE(camera.getProjectionMatrixAsFrustum(left, right, bottom, top, nearest, farthest));
                matrix(2, 2) = 0.0;
                matrix(3, 2) = nearest;
            }
            camera.setProjectionMatrix(matrix);
            camera.setClearDepth(0.0);
            state.setAttributeAndModes(new osg::Depth(osg::Depth::GREATER));
            if (clipControl)
                state.setAttribute(
                    new osg::ClipControl(osg::ClipControl::LOWER_LEFT, osg::ClipControl::ZERO_TO_ONE));
        }
        scene.setDepthConvention({convention, farDistance});
    }

    /// For what the application draws by itself: a program that knows nothing of the kit; null where none is needed.
    osg::ref_ptr<osg::Program> hostProgram() const
    {
        if (!logarithmic()) return nullptr;
        std::ostringstream factor;
        factor.precision(17);
        factor << 2.0 / std::log2(farDistance + 1.0);
        HostProgram host("#version 120\n", "gl_Position = ftransform();\n    flogz = 1.0 + gl_Position.w;",
                         "varying float flogz;\n");
        if (convention == osgGeoFX::DepthConvention::LOGARITHMIC)
            host = HostProgram(
                "#version 120\n",
                "gl_Position = ftransform();\n    gl_Position.z = (log2(max(1e-6, 1.0 + gl_Position.w)) * " +
                    factor.str() + " - 1.0) * gl_Position.w;");
        else
            host.fragments = {
                "#version 120\nDEFINES\nvarying float flogz;\nvoid main()\n{\n    gl_FragColor = gl_Color;\n"
                "    gl_FragDepth = 0.5 * " +
                factor.str() + " * log2(flogz);\n}\n"};
        return host.make(false);
    }
};

inline std::ostream& operator<<(std::ostream& stream, const DepthKind& kind)
{
    return stream << kind.name;
}

} // namespace geofx::test
