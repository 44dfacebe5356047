// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// What raster coordinates change by along a step, which chooses how a raster is filtered: the derivative of the projections.
#include <osgGeoFX/effect/GlslFunctions.h>
#include <tools/RandomSamples.h>

#include <gtest/gtest.h>

namespace glsl = osgGeoFX::glsl;
using namespace geofx::test;

namespace
{

glm::dvec3 randomVector(Random& random, double reach)
{
    return {random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach)};
}

/// Expects the step's change to be what a thousandth of it makes, to both sides.
template<typename Projection, typename Vector>
void expectDerivative(const Projection& project, const glm::dvec2& given, const Vector& at,
                      const Vector& step)
{
    const glm::dvec2 difference = (project(at + 1e-3 * step) - project(at - 1e-3 * step)) / 2e-3;
    EXPECT_LT(glm::distance(given, difference), 1e-4 * (1.0 + glm::length(difference)));
}

glsl::geofx_Pinhole randomPinhole(Random& random)
{
    glsl::geofx_Pinhole camera;
    camera.eye = randomVector(random, 100.0);
    camera.forward = glm::normalize(randomVector(random, 1.0));
    const glm::dvec3 right = glm::normalize(glm::cross(camera.forward, randomVector(random, 1.0)));
    camera.tangents = {random.uniform(0.2, 1.0), random.uniform(0.2, 1.0)};
    camera.right = right / camera.tangents.x;
    camera.up = glm::cross(right, camera.forward) / camera.tangents.y;
    camera.radial = randomVector(random, 0.1);
    camera.tangential = glm::dvec2(randomVector(random, 0.02));
    camera.reach = 1e4;
    return camera;
}

} // namespace

TEST(MappingProjection, StepsInThePlaneAreItsDerivative)
{
    for (int i = 0; i < sampleCount(); ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const glsl::geofx_Projector projector = {
            glm::dvec2(randomVector(random, 1000.0)), glm::dvec2(randomVector(random, 1e-2)),
            glm::dvec2(randomVector(random, 1e-2)), glm::dvec2(randomVector(random, 1e-3))};
        const glm::dvec2 place = projector.center + glm::dvec2(randomVector(random, 400.0));
        const glm::dvec2 step(randomVector(random, 5.0));
        expectDerivative([&](const glm::dvec2& at) { return glsl::geofx_projectPlane(projector, at); },
                         glsl::geofx_projectPlaneStep(projector, place, step), place, step);
    }
}

TEST(MappingProjection, StepsBeforeACameraAreItsDerivative)
{
    for (int i = 0; i < sampleCount(); ++i)
    {
        SCOPED_TRACE("sample " + std::to_string(i));
        Random random(static_cast<std::uint64_t>(i));
        const glsl::geofx_Pinhole camera = randomPinhole(random);
        const double depth = random.uniform(50.0, 500.0);
        const glm::dvec3 place = camera.eye + camera.forward * depth + randomVector(random, depth / 2.0);
        const glm::dvec3 step = randomVector(random, 5.0);
        expectDerivative([&](const glm::dvec3& at) { return glsl::geofx_projectPinhole(camera, at); },
                         glsl::geofx_projectPinholeStep(camera, place, step), place, step);
    }
}

TEST(MappingProjection, StepsBeyondTheHorizonStayDerivatives)
{
    // The next pixel may see what lies behind the projection's horizon, or behind a camera.
    const glsl::geofx_Projector projector = {{0.0, 0.0}, {1e-3, 0.0}, {0.0, 1e-3}, {0.0, -1e-3}};
    const glm::dvec2 up = glsl::geofx_projectPlaneStep(projector, {0.0, 100.0}, {0.0, 5000.0});
    EXPECT_NEAR(up.y, 5000.0 * 1e-3 / (0.9 * 0.9), 1e-9);
    glsl::geofx_Pinhole camera = {};
    camera.right = {1.0, 0.0, 0.0};
    camera.up = {0.0, 1.0, 0.0};
    camera.forward = {0.0, 0.0, -1.0};
    camera.tangents = {1.0, 1.0};
    camera.reach = 1e4;
    const glm::dvec2 across = glsl::geofx_projectPinholeStep(camera, {10.0, 0.0, -100.0}, {0.0, 0.0, 1000.0});
    EXPECT_NEAR(across.x, 0.5 * 10.0 * 1000.0 / (100.0 * 100.0), 1e-9);
}
