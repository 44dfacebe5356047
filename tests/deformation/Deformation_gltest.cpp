// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The deformations on the GPU, in the very shaders and with the very uniforms of a frame, against the CPU's double.
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/scene/detail/EffectProgram.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <tools/GlFixture.h>
#include <tools/RandomViews.h>

#include <osg/Geometry>
#include <osg/Program>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

using namespace geofx::test;
using osg::Vec3d;
using osgGeoFX::DeformationChain;
using osgGeoFX::EffectProgram;

namespace
{

constexpr int columns = 256;

/// Effects before one camera, and the points that they get: one row of the picture.
struct Row
{
    EffectProgram::Effects effects;
    std::vector<osg::ref_ptr<const osgGeoFX::DeformationSnapshot>>
        snapshots; ///< null where an effect does nothing
    osg::ref_ptr<DeformationChain> chain;
    std::vector<osg::Vec3f> points;
    std::vector<osg::Vec3f> normals;
    double least = 0.0; ///< the least viewing distance, metres: of an orthographic camera, its picture's size
    std::string text;
};

struct Result
{
    Vec3d place;
    Vec3d normal;
    double style;
};

Row randomRow(int number)
{
    for (std::uint64_t attempt = 0;; ++attempt)
    {
        Random random(static_cast<std::uint64_t>(number) + (attempt << 32));
        const CameraPose pose = randomPose(random);
        const osgGeoFX::ViewGeometry view = pose.view();
        Row row;
        row.chain = new DeformationChain;
        std::ostringstream text;
        for (int i = random.integer(1, 2); i > 0; --i)
        {
            const auto effect = randomDeformation(random);
            bringNear(*effect, pose, random);
            row.effects.emplace_back(effect);
            row.snapshots.push_back(effect->snapshot(view));
            if (row.snapshots.back()) row.chain->add(row.snapshots.back());
            text << describe(*effect) << "; ";
        }
        if (row.chain->empty()) continue;
        text << pose;
        row.text = text.str();
        if (pose.lens == CameraPose::ORTHOGRAPHIC) row.least = pose.pictureSize;
        for (int i = 0; i < columns; ++i)
        {
            const Vec3d point = randomPointFor(*row.chain->snapshots()[0], view, random);
            row.points.emplace_back(point);
            row.normals.emplace_back(randomDirection(random));
        }
        return row;
    }
}

/// By how much a chain stretches about a point.
double stretchAt(const DeformationChain& chain, Vec3d point)
{
    double stretch = 1.0;
    for (const auto& snapshot : chain.snapshots())
    {
        stretch *= snapshot->lipschitz({point, 0.0});
        point = snapshot->deform(point);
    }
    return stretch;
}

/// Heights count from the reference plane, which may be kilometres away from a point near the eye.
double roundingOfHeights(const DeformationChain& chain)
{
    double lost = 0.0;
    for (const auto& snapshot : chain.snapshots())
    {
        BendNumbers bend;
        if (bendNumbers(*snapshot, bend)) lost += 1e-7 * std::abs(bend.height);
    }
    return lost;
}

/// What is lost beside 1e-5 of the distance: where the eye itself is in a wide zone, the place along the zone is
/// rounded as a share of its width, however near a point is.
double behindTheEye(const DeformationChain& chain)
{
    double lost = 0.0;
    for (const auto& snapshot : chain.snapshots())
    {
        BendNumbers bend;
        LibertyNumbers liberty;
        if (bendNumbers(*snapshot, bend) && bend.start < 0.0) lost += 2e-7 * bend.size;
        // A region's places count from its center, which may be far from what is near the eye.
        if (libertyNumbers(*snapshot, liberty)) lost += 1e-7 * (liberty.across + liberty.along);
    }
    return lost;
}

/// Style and normal of a point. `off`: by how much its place differs, metres.
void expectSameLook(const Row& row, std::size_t i, const Result& gpu, double off)
{
    Vec3d point = row.points[i];
    Vec3d normal = row.normals[i];
    double style = 0.0;
    double allowed = 1e-5, allowedOfNormal = 1e-4;
    const double start = point.length();
    for (std::size_t k = 0; k < row.snapshots.size(); ++k)
    {
        const osgGeoFX::DeformationSnapshot* snapshot = row.snapshots[k];
        if (!snapshot) continue;
        style = std::max(style, snapshot->style(point));
        BendNumbers bend;
        if (bendNumbers(*snapshot, bend))
        {
            // The ground is lit as it lies. A style is a place along the zone, as a share of its width.
            const double scale = std::abs(bend.start) + bend.size + start + point.length();
            allowed += 1e-6 * scale / std::max(bend.size, 1e-3);
        }
        else if (!row.effects[k]->property("relight") || row.effects[k]->getProperty("relight") != 0.0)
        {
            normal = snapshot->deformNormal(point, normal);
        }
        // Where a region is steep, its normals are rounded as its places are, as a share of its size.
        LibertyNumbers liberty;
        if (libertyNumbers(*snapshot, liberty))
            allowedOfNormal += 20.0 * off / std::min(liberty.across, liberty.along);
        point = snapshot->deform(point);
    }
    EXPECT_NEAR(gpu.style, style, allowed * stretchAt(*row.chain, row.points[i]));
    EXPECT_LT((gpu.normal - normal).length(), allowedOfNormal);
}

osg::ref_ptr<osg::Image> makeFloatImage(int rows)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(columns, rows, 1, GL_RGBA, GL_FLOAT);
    image->setInternalTextureFormat(GL_RGBA32F_ARB);
    std::memset(image->data(), 0, image->getTotalSizeInBytes());
    return image;
}

const char* const vertexShader = R"(#version 330 compatibility
vec4 geofx_vertex(vec4 eyePosition);
vec3 geofx_normal(vec4 eyePosition, vec3 eyeNormal);
flat out vec4 place;
flat out vec3 normal;
void main()
{
    place = geofx_vertex(gl_Vertex);
    normal = geofx_normal(gl_Vertex, gl_Normal);
    gl_Position = vec4(gl_MultiTexCoord0.xy, 0.0, 1.0);
}
)";

const char* const fragmentShader = R"(#version 330 compatibility
flat in vec4 place;
flat in vec3 normal;
in float geofx_styleBlend;
layout(location = 0) out vec4 places;
layout(location = 1) out vec4 normals;
void main()
{
    places = vec4(place.xyz / place.w, geofx_styleBlend);
    normals = vec4(normal, 1.0);
}
)";

} // namespace

class DeformationOnGpu : public GlFixture
{
protected:
    DeformationOnGpu() : GlFixture(16, 16) {}

    /// Draws each point as one pixel into float textures.
    std::vector<std::vector<Result>> run(const std::vector<Row>& rows)
    {
        const int height = static_cast<int>(rows.size());
        const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
        camera->setRenderOrder(osg::Camera::PRE_RENDER);
        camera->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT, osg::Camera::FRAME_BUFFER);
        camera->setViewport(0, 0, columns, height);
        camera->setReferenceFrame(osg::Transform::ABSOLUTE_RF);
        camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
        camera->setCullingMode(osg::CullSettings::NO_CULLING);
        std::vector<osg::ref_ptr<osg::Image>> images;
        for (int i = 0; i < 2; ++i)
        {
            images.push_back(makeFloatImage(height));
            camera->attach(static_cast<osg::Camera::BufferComponent>(osg::Camera::COLOR_BUFFER0 + i),
                           images.back());
        }
        for (int i = 0; i < height; ++i)
            camera->addChild(drawingOf(rows[static_cast<std::size_t>(i)], i, height));
        render(camera);

        std::vector<std::vector<Result>> results;
        const auto* places = reinterpret_cast<const float*>(images[0]->data());
        const auto* normals = reinterpret_cast<const float*>(images[1]->data());
        for (std::size_t row = 0; row < rows.size(); ++row)
        {
            results.emplace_back();
            for (int i = 0; i < columns; ++i, places += 4, normals += 4)
            {
                EXPECT_EQ(normals[3], 1.0f) << "nothing was drawn";
                results.back().push_back({osg::Vec3f(places[0], places[1], places[2]),
                                          osg::Vec3f(normals[0], normals[1], normals[2]),
                                          static_cast<double>(places[3])});
            }
        }
        return results;
    }

private:
    osg::ref_ptr<osg::Geometry> drawingOf(const Row& row, int number, int height)
    {
        osg::ref_ptr<osg::Geometry> drawing = new osg::Geometry;
        const osg::ref_ptr<osg::Vec2Array> pixels = new osg::Vec2Array;
        for (int i = 0; i < columns; ++i)
            pixels->push_back(
                {(2.0f * static_cast<float>(i) + 1.0f) / columns - 1.0f,
                 (2.0f * static_cast<float>(number) + 1.0f) / static_cast<float>(height) - 1.0f});
        drawing->setVertexArray(new osg::Vec3Array(row.points.begin(), row.points.end()));
        drawing->setNormalArray(new osg::Vec3Array(row.normals.begin(), row.normals.end()),
                                osg::Array::BIND_PER_VERTEX);
        drawing->setTexCoordArray(0, pixels, osg::Array::BIND_PER_VERTEX);
        drawing->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, columns));
        drawing->setUseDisplayList(false);
        drawing->setUseVertexBufferObjects(true);
        osg::StateSet* state = drawing->getOrCreateStateSet();
        state->setAttributeAndModes(programOf(row.effects));
        state->setDefine("GEOFX_DEFORMATION");
        for (std::size_t i = 0; i < row.effects.size(); ++i)
        {
            if (!row.snapshots[i]) continue;
            state->setDefine(EffectProgram::define(i));
            for (const auto& [name, value] : row.snapshots[i]->uniforms())
            {
                const std::string full = EffectProgram::prefix(i) + name;
                state->addUniform(new osg::Uniform(full.c_str(), osg::Vec4f(value)));
            }
        }
        return drawing;
    }

    osg::Program* programOf(const EffectProgram::Effects& effects)
    {
        osg::ref_ptr<osg::Program>& program = _programs[EffectProgram::key(effects)];
        if (!program)
        {
            program = new osg::Program;
            program->addShader(new osg::Shader(osg::Shader::VERTEX, vertexShader));
            program->addShader(
                new osg::Shader(osg::Shader::VERTEX, EffectProgram::functions(effects, osg::Shader::VERTEX)));
            program->addShader(new osg::Shader(osg::Shader::FRAGMENT, fragmentShader));
        }
        return program;
    }

    std::map<std::string, osg::ref_ptr<osg::Program>> _programs;
};

TEST_F(DeformationOnGpu, GpuResultIsCpuResult)
{
    std::vector<Row> rows;
    for (int i = 0; i < (fullTest() ? 1000 : 100); ++i)
        rows.push_back(randomRow(i));
    const std::vector<std::vector<Result>> results = run(rows);
    double worst = 0.0;
    std::string where;
    int stretched = 0;
    for (std::size_t row = 0; row < rows.size(); ++row)
    {
        for (std::size_t i = 0; i < columns; ++i)
        {
            const Vec3d point = rows[row].points[i];
            const Vec3d expected = rows[row].chain->deform(point);
            const Result& gpu = results[row][i];
            const double distance = std::max({point.length(), expected.length(), rows[row].least});
            const double error = (gpu.place - expected).length() / distance;
            // What stands kilometres high in a zone of a few metres is stretched a thousandfold, and so is the rounding
            // of its position to floats.
            const double stretch = std::max(1.0, stretchAt(*rows[row].chain, point) / 10.0);
            if (stretch > 1.0) ++stretched;
            if (error > worst && stretch == 1.0 && behindTheEye(*rows[row].chain) == 0.0)
            {
                worst = error;
                where = rows[row].text;
            }
            SCOPED_TRACE(::testing::Message()
                         << "row " << row << ", point " << i << ", distance " << point.length() << ", then "
                         << expected.length() << ", off by " << error * distance << " m: " << rows[row].text);
            // Each effect rounds.
            const double share = 1e-5 * static_cast<double>(rows[row].chain->snapshots().size());
            const double lost = behindTheEye(*rows[row].chain) + roundingOfHeights(*rows[row].chain);
            EXPECT_LT(error * distance, (share * distance + lost) * stretch);
            expectSameLook(rows[row], i, gpu, error * distance);
            if (HasFailure()) return;
        }
    }
    RecordProperty("worst_share_of_distance", std::to_string(worst * 1e6) + "e-6");
    RecordProperty("worst_at", where);
    EXPECT_LT(stretched, static_cast<int>(rows.size()) * columns / 4);
}

namespace
{

/// Half the height of the picture in which vertices must stand still, pixels.
constexpr double halfHeight = 345.0;

/// A camera over a globe that looks at the ground, at any height from a walker's to an orbit's.
CameraPose randomPoseOverAGlobe(Random& random)
{
    CameraPose pose;
    pose.globe = true;
    pose.x = random.uniform(-3.1, 3.1);
    pose.y = random.uniform(-1.4, 1.4);
    pose.height = random.logarithmic(2.0, 2e7);
    pose.heading = random.uniform(-3.1, 3.1);
    // Towards the horizon, or anything below it.
    const double horizon = std::acos(6.37e6 / (6.37e6 + pose.height));
    pose.pitch = -(horizon + random.uniform(0.0, 1.0) * (1.5 - horizon));
    pose.fieldOfView = 0.698;
    pose.aspect = 1089.0 / 690.0;
    return pose;
}

/// A place on the ground in a camera's picture, world coordinates; nothing where there is sky.
std::optional<Vec3d> randomGroundInSight(const CameraPose& pose, Random& random)
{
    const osg::Matrixd back = osg::Matrixd::inverse(pose.modelView() * pose.projection());
    const osg::Vec2d pixel(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    const Vec3d near = Vec3d(pixel.x(), pixel.y(), -1.0) * back;
    Vec3d way = Vec3d(pixel.x(), pixel.y(), 1.0) * back - near;
    way.normalize();
    // Of a ball that is a little larger or smaller than the Earth there.
    const double radius =
        near.length() - pose.height + random.uniform(0.0, 0.2) * std::min(pose.height, 5000.0);
    const double along = near * way;
    const double root = along * along - near.length2() + radius * radius;
    if (root < 0.0 || along > 0.0) return std::nullopt;
    return near + way * (-along - std::sqrt(root));
}

/// A vertex of a tile in eye space, as the GPU's floats have it.
osg::Vec3f inFloats(const Vec3d& world, const osg::Matrixd& tile, const osg::Matrixd& modelView)
{
    const osg::Vec3f local(world * osg::Matrixd::inverse(tile));
    return local * osg::Matrixf(tile * modelView);
}

} // namespace

// While the camera stands or creeps, no vertex moves by more than 0.2 pixels, at any height from 2 m to 20,000 km.
TEST_F(DeformationOnGpu, VerticesStandStillFromTheGroundToOrbit)
{
    const osg::ref_ptr<osg::EllipsoidModel> earth = new osg::EllipsoidModel;
    const std::vector<std::string> kinds = deformationKinds();
    std::vector<Row> rows;
    std::vector<CameraPose> poses;
    std::vector<Vec3d> allPlaces; // `columns` for each pair of rows
    std::vector<osg::Matrixd> views;
    for (std::uint64_t i = 0; rows.size() < (fullTest() ? 2000u : 200u); ++i)
    {
        Random random(i);
        const CameraPose pose = randomPoseOverAGlobe(random);
        const osg::ref_ptr<osgGeoFX::Effect> effect =
            osgGeoFX::createEffect(kinds[static_cast<std::size_t>(i) % kinds.size()]);
        std::string refusal;
        effect->setProperty("factor", 2.5, refusal);
        // Two cameras that stand a millionth of their height apart.
        std::array<osg::Matrixd, 2> cameras = {pose.modelView(), pose.modelView()};
        cameras[1].postMultTranslate(randomDirection(random) * (1e-6 * pose.height));
        std::array<Row, 2> pair;
        std::vector<Vec3d> places;
        for (int tries = 0; places.size() < columns && tries < 20 * columns; ++tries)
        {
            if (const std::optional<Vec3d> place = randomGroundInSight(pose, random))
                places.push_back(*place);
        }
        if (places.size() < columns) continue;
        for (std::size_t k = 0; k < 2; ++k)
        {
            const osgGeoFX::ViewGeometry view(cameras[k], pose.projection(), pose.ground());
            Row& row = pair[k];
            row.chain = new DeformationChain;
            row.effects.push_back(effect);
            row.snapshots.push_back(effect->asDeformation()->snapshot(view));
            if (row.snapshots[0]) row.chain->add(row.snapshots[0]);
            std::ostringstream text;
            text << describe(*effect) << "; " << pose;
            row.text = text.str();
            for (const Vec3d& place : places)
            {
                // A tile as large as half the way to the eye, whose middle is somewhere on it.
                const double size = 0.25 * (place * cameras[0]).length();
                osg::Matrixd tile;
                double latitude, longitude, height;
                earth->convertXYZToLatLongHeight(place.x(), place.y(), place.z(), latitude, longitude,
                                                 height);
                earth->computeLocalToWorldTransformFromLatLongHeight(latitude + 0.5 * size / 6.37e6,
                                                                     longitude, 0.0, tile);
                row.points.push_back(inFloats(place, tile, cameras[k]));
                row.normals.emplace_back(0.0f, 0.0f, 1.0f);
            }
        }
        for (std::size_t k = 0; k < 2; ++k)
        {
            rows.push_back(pair[k]);
            poses.push_back(pose);
            views.push_back(cameras[k]);
        }
        allPlaces.insert(allPlaces.end(), places.begin(), places.end());
    }
    const std::vector<std::vector<Result>> results = run(rows);
    double worst = 0.0;
    std::string where;
    int seen = 0;
    for (std::size_t i = 0; i < rows.size(); i += 2)
    {
        const osg::Matrixd projection = poses[i].projection();
        for (std::size_t column = 0; column < columns; ++column)
        {
            const Vec3d place = allPlaces[i / 2 * columns + column];
            osg::Vec2d moved;
            bool inPicture = true;
            for (std::size_t k = 0; k < 2; ++k)
            {
                const Vec3d eye = place * views[i + k];
                const DeformationChain& chain = *rows[i + k].chain;
                const osg::Vec4d exact = osg::Vec4d(chain.deform(eye), 1.0) * projection;
                const osg::Vec4d drawn = osg::Vec4d(results[i + k][column].place, 1.0) * projection;
                const auto pixel = [&](const osg::Vec4d& clip)
                {
                    return osg::Vec2d(clip.x() * poses[i].aspect, clip.y()) * (halfHeight / clip.w());
                };
                inPicture = inPicture && exact.w() > 0.0 && std::abs(exact.x()) < exact.w() &&
                            std::abs(exact.y()) < exact.w() && !chain.hides(osgGeoFX::Ball{eye, 0.0}, {});
                moved += (pixel(drawn) - pixel(exact)) * (k ? 1.0 : -1.0);
            }
            if (!inPicture) continue;
            ++seen;
            if (moved.length() <= worst) continue;
            worst = moved.length();
            where = rows[i].text;
        }
    }
    RecordProperty("worst_pixels", std::to_string(worst));
    std::cout << "at most " << worst << " pixels, of " << seen << " vertices: " << where << '\n';
    EXPECT_GT(seen, static_cast<int>(rows.size() / 2 * columns) / 4);
    EXPECT_LE(worst, 0.2);
}
