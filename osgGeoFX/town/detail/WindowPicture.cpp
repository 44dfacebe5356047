// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/town/detail/WindowPicture.h>

#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/effect/detail/TownState.h>
#include <osgGeoFX/town/detail/Scatter.h>

#include <osg/Material>
#include <osg/Texture2D>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgGeoFX
{

namespace
{

constexpr int WIDTH = WindowPicture::columns * WindowPicture::cell;
constexpr int HEIGHT = 2048;
static_assert(BUILDING_USES * WindowPicture::rows * WindowPicture::cell + 64 <= HEIGHT);

/// A number that looks random, 0 to 1, the same for the same three.
double scattered(int a, int b, int c)
{
    return scatter(static_cast<std::uint32_t>(a) * 73856093u ^ static_cast<std::uint32_t>(b) * 19349663u ^
                   static_cast<std::uint32_t>(c) * 83492791u);
}

/// What glass takes of a wall's color: some panes are dark, some have curtains, and some reflect the sky.
osg::Vec3d glass(BuildingUse use, int column, int row)
{
    const double chance = scattered(static_cast<int>(use), column, row);
    const double sky = use == BuildingUse::TOWER ? 0.5 : use == BuildingUse::OFFICE ? 0.3 : 0.12;
    const double shade = scattered(row, static_cast<int>(use), column + 7);
    if (chance < sky) return osg::Vec3d(0.66, 0.75, 0.84) * (0.85 + 0.25 * shade);
    if (chance > 0.9) return osg::Vec3d(0.84, 0.80, 0.73);
    return osg::Vec3d(0.40, 0.44, 0.50) * (0.8 + 0.5 * shade);
}

/// The texel x, y of the window in a column and row. y is 0 at the storey's floor.
osg::Vec3d texel(BuildingUse use, int column, int row, int x, int y)
{
    const osg::Vec3d wall(1.0, 1.0, 1.0), frame(0.86, 0.86, 0.85), shadow(0.74, 0.73, 0.72);
    const osg::Vec3d pane = glass(use, column, row);
    const auto inside = [&](int left, int right, int bottom, int top)
    {
        return x >= left && x < right && y >= bottom && y < top;
    };
    switch (use)
    {
    case BuildingUse::HOUSE:
        // Some parts of a wall have no window.
        if (scattered(column, row, 3) < 0.3) return wall;
        if (inside(4, 12, 5, 13)) return inside(5, 11, 6, 12) && x != 8 ? pane : frame;
        return wall;
    case BuildingUse::FLATS:
        // A balcony's parapet, and its shadow.
        if (column % 4 == 1)
            return y < 5 ? frame : y > 13 ? shadow : inside(2, 14, 5, 14) ? pane * 0.8 : wall;
        if (inside(3, 13, 4, 13)) return inside(4, 12, 5, 12) && x != 8 ? pane : frame;
        return y == 0 ? shadow : wall;
    case BuildingUse::OFFICE:
        if (y < 5 || y > 13) return y == 5 || y == 14 ? shadow : wall;
        return x == 0 ? frame : pane;
    case BuildingUse::TOWER:
        if (y < 2) return shadow;
        return x == 0 || y == 2 ? osg::Vec3d(0.62, 0.65, 0.68) : pane * 1.15;
    case BuildingUse::HALL:
        if (inside(1, 15, 10, 13)) return x % 5 == 0 ? frame : pane;
        return x % 4 == 0 ? osg::Vec3d(0.93, 0.93, 0.93) : wall;
    }
    return wall;
}

int firstRow(BuildingUse use)
{
    return static_cast<int>(use) * WindowPicture::rows;
}

} // namespace

osg::ref_ptr<osg::Image> WindowPicture::create()
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(WIDTH, HEIGHT, 1, GL_RGB, GL_UNSIGNED_BYTE, 1);
    image->setInternalTextureFormat(GL_RGB8);
    image->setFileName("windows");
    std::fill_n(image->data(), image->getTotalSizeInBytes(), static_cast<unsigned char>(255));
    for (int use = 0; use < BUILDING_USES; ++use)
        for (int y = 0; y < rows * cell; ++y)
            for (int x = 0; x < WIDTH; ++x)
            {
                const osg::Vec3d color =
                    texel(static_cast<BuildingUse>(use), x / cell, y / cell, x % cell, y % cell);
                unsigned char* to = image->data(x, firstRow(static_cast<BuildingUse>(use)) * cell + y);
                for (int channel = 0; channel < 3; ++channel)
                    to[channel] = static_cast<unsigned char>(
                        std::lround(255.0 * std::clamp(color[static_cast<unsigned int>(channel)], 0.0, 1.0)));
            }
    return image;
}

osg::Vec3d WindowPicture::mean(BuildingUse use)
{
    static const std::array<osg::Vec3d, BUILDING_USES> means = []
    {
        std::array<osg::Vec3d, BUILDING_USES> result;
        for (int i = 0; i < BUILDING_USES; ++i)
        {
            osg::Vec3d sum;
            for (int y = 0; y < rows * cell; ++y)
                for (int x = 0; x < WIDTH; ++x)
                {
                    const osg::Vec3d color =
                        texel(static_cast<BuildingUse>(i), x / cell, y / cell, x % cell, y % cell);
                    for (unsigned int channel = 0; channel < 3; ++channel)
                        sum[channel] += std::clamp(color[channel], 0.0, 1.0);
                }
            result[static_cast<std::size_t>(i)] = sum / static_cast<double>(rows * cell * WIDTH);
        }
        return result;
    }();
    return means[static_cast<std::size_t>(use)];
}

double WindowPicture::storey(BuildingUse use, double storeys)
{
    return (firstRow(use) + ground + storeys) * cell / HEIGHT;
}

osg::Vec2d WindowPicture::plain()
{
    return {0.5, 1.0 - 32.0 / HEIGHT};
}

osg::ref_ptr<osg::StateSet> createTownState()
{
    osg::ref_ptr<osg::StateSet> state = new osg::StateSet;
    osg::ref_ptr<osg::Texture2D> windows = new osg::Texture2D(WindowPicture::create());
    windows->setName(TownState::texture);
    windows->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR_MIPMAP_LINEAR);
    windows->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    windows->setWrap(osg::Texture::WRAP_S, osg::Texture::REPEAT);
    windows->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    windows->setMaxAnisotropy(4.0f);
    state->setTextureAttributeAndModes(0, windows);
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setColorMode(osg::Material::AMBIENT_AND_DIFFUSE);
    material->setAmbient(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    // What streets and neighbours reflect: a wall in the shade is not as dark as the ground on a slope.
    material->setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0.11f, 0.11f, 0.11f, 1.0f));
    state->setAttributeAndModes(material);
    // Buildings are seen from outside alone.
    state->setMode(GL_CULL_FACE, osg::StateAttribute::ON);
    state->setDefine(RigidParts::define);
    return state;
}

} // namespace osgGeoFX
