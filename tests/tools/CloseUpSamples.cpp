// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/CloseUpSamples.h>

#include <osg/Math>

#include <cmath>
#include <functional>

using namespace osgGeoFX;

namespace geofx::test
{

namespace
{

osg::ref_ptr<osg::Image> makeMaskImage(Random& random)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(24, 24, 1, GL_LUMINANCE, GL_UNSIGNED_BYTE);
    const double x = random.uniform(-0.4, 0.4);
    const double y = random.uniform(-0.4, 0.4);
    for (int j = 0; j < 24; ++j)
    {
        for (int i = 0; i < 24; ++i)
        {
            const double far = std::hypot((i - 11.5) / 12.0 - x, (j - 11.5) / 12.0 - y);
            *image->data(static_cast<unsigned int>(i), static_cast<unsigned int>(j)) =
                static_cast<unsigned char>(255.0 * std::min(std::max(1.5 - 2.0 * far, 0.0), 1.0));
        }
    }
    return image;
}

osg::ref_ptr<osg::Image> makeLayer(int side, const std::function<osg::Vec4(double u, double v)>& texel)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(side, side, 1, GL_RGBA, GL_FLOAT);
    auto* texels = reinterpret_cast<osg::Vec4f*>(image->data());
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            *texels++ = texel((column + 0.5) / side, (row + 0.5) / side);
    return image;
}

void randomizeAnchor(Anchor& anchor, Random& random)
{
    anchor.setKind(static_cast<Anchor::Kind>(random.integer(0, 2)));
    anchor.setStyle(static_cast<Anchor::Style>(random.integer(0, 6)));
    anchor.setOpacity(random.uniform(0.3, 1.0));
    anchor.setLineWidth(random.integer(0, 2) ? random.uniform(1.0, 4.0) : 0.0);
}

void randomizeStyle(CloseUp& closeUp, Random& random)
{
    closeUp.setColor(
        osg::Vec3(osg::Vec3d(random.uniform(0.2, 1.0), random.uniform(0.2, 1.0), random.uniform(0.2, 1.0))));
    const char* const layers[] = {"", "", "color", "height", "normal", "class", "none of that name"};
    closeUp.setSurface(layers[random.integer(0, 6)]);
    closeUp.setSurfaceOpacity(random.integer(0, 1) ? 1.0 : random.uniform(0.2, 1.0));
    closeUp.setLighting(static_cast<CloseUp::Lighting>(random.integer(0, 2)));
    closeUp.setSun(random.uniform(0.0, 6.0), random.uniform(0.2, 1.5));
    closeUp.setSaturation(random.integer(0, 2) ? 1.0 : random.uniform(0.0, 2.0));
    closeUp.setContrast(random.integer(0, 2) ? 1.0 : random.uniform(0.5, 1.5));
    closeUp.setBrightness(random.integer(0, 2) ? 0.0 : random.uniform(-0.2, 0.3));
    closeUp.setOpacity(random.integer(0, 3) ? 1.0 : random.uniform(0.3, 1.0));
    closeUp.setActivity(static_cast<CloseUp::Activity>(random.integer(0, 2) ? 0 : random.integer(0, 3)));
    closeUp.setMappingChannels(random.integer(0, 2) ? 255 : random.integer(0, 3));
}

} // namespace

osg::ref_ptr<RegionOfInterest> randomRegion(Random& random, const CloseUpPlan& plan)
{
    osg::ref_ptr<RegionOfInterest> region = new RegionOfInterest;
    const osg::Vec2d off(random.uniform(-plan.reach, plan.reach), random.uniform(-plan.reach, plan.reach));
    constexpr double metresPerRadian = 6.37e6;
    if (plan.globe)
    {
        const double east = off.x() / metresPerRadian / std::cos(plan.center.y());
        region->setGeodeticCenter(std::remainder(plan.center.x() + east, 2.0 * osg::PI),
                                  plan.center.y() + off.y() / metresPerRadian);
    }
    else
        region->setCenter(plan.center + off);
    const double width = plan.size * random.logarithmic(0.4, 2.0);
    region->setSize(width, random.integer(0, 1) ? width : width * random.logarithmic(0.5, 2.0));
    region->setHeading(random.integer(0, 1) ? random.uniform(-3.0, 3.0) : 0.0);
    region->setBaseHeight(random.integer(0, 1) ? 0.0 : random.uniform(-0.1, 0.1) * plan.size);
    const auto shape = static_cast<RegionOfInterest::Shape>(random.integer(0, 5));
    if (shape == RegionOfInterest::IMAGE) region->setImage(makeMaskImage(random));
    if (shape == RegionOfInterest::POLYGON)
        region->setOutline(
            {{-0.9, -0.8}, {0.7, -1.0}, {1.0, random.uniform(-0.5, 0.9)}, {0.0, 0.1}, {-0.6, 1.0}});
    region->setShape(shape);
    region->setSoftness(random.integer(0, 1) ? 0.0 : random.uniform(0.05, 0.6));
    region->setMaskSide(32 << random.integer(0, 2));
    return region;
}

osg::ref_ptr<CloseUp> randomCloseUp(Random& random, const CloseUpPlan& plan)
{
    osg::ref_ptr<CloseUp> closeUp = new CloseUp;
    closeUp->setRegion(randomRegion(random, plan));
    const double aside = random.integer(0, 1) ? 0.0 : plan.size;
    closeUp->setOffset({random.uniform(-aside, aside), random.uniform(-aside, aside),
                        plan.rise * random.logarithmic(0.3, 2.0)});
    const double scale = random.logarithmic(0.6, 3.0);
    closeUp->setScale(scale, random.integer(0, 2) ? scale : scale * random.logarithmic(0.6, 1.6),
                      random.integer(0, 3) ? scale * random.logarithmic(0.5, 2.0) : 0.0);
    if (plan.oriented) closeUp->setOrientation(static_cast<CloseUp::Orientation>(random.integer(0, 2)));
    closeUp->setTilt(random.integer(0, 1) ? random.uniform(-1.2, 1.2) : 0.0);
    closeUp->setTurn(random.integer(0, 1) ? random.uniform(-3.0, 3.0) : 0.0);
    closeUp->setEdge(static_cast<CloseUp::Edge>(random.integer(0, 1)));
    randomizeStyle(*closeUp, random);
    if (plan.anchors)
        randomizeAnchor(*closeUp->getAnchor(), random);
    else
    {
        closeUp->getAnchor()->setKind(Anchor::NONE);
        closeUp->getAnchor()->setLineWidth(0.0);
    }
    return closeUp;
}

osg::ref_ptr<SurfaceData> makeSurfaceData(const CloseUpPlan& plan, double half, int side)
{
    osg::ref_ptr<SurfaceData> data = new SurfaceData;
    if (plan.globe)
        data->setGeodeticOrigin(plan.center.x(), plan.center.y());
    else
        data->setOrigin(plan.center);
    data->setRectangle({-half, -half}, {half, half});
    const auto value = [](double amount)
    {
        const auto rounded = static_cast<float>(amount);
        return osg::Vec4(rounded, rounded, rounded, 1.0f);
    };
    data->addLayer("color", SurfaceData::COLOR,
                   makeLayer(side, [](double u, double v)
                             { return osg::Vec4(osg::Vec4d(u, v, 0.5 + 0.5 * std::sin(20.0 * u), 1.0)); }));
    data->addLayer("height", SurfaceData::HEIGHT,
                   makeLayer(side, [&](double u, double v)
                             { return value(100.0 * std::sin(9.0 * u) * std::cos(7.0 * v)); }));
    data->addDerived("normal", SurfaceData::NORMAL);
    data->addLayer("class", SurfaceData::CLASS,
                   makeLayer(side, [&](double u, double v)
                             { return value(std::floor(4.0 * u) + 4.0 * std::floor(4.0 * v)); }));
    return data;
}

} // namespace geofx::test
