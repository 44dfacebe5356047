// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "Effects.h"

#include "Ground.h"

#include <osgGeoFX/closeup/CloseUps.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/viewer/EffectKinds.h>
#include <osgGeoFX/viewer/ViewPoint.h>

#include <osg/Math>
#include <osgDB/ReadFile>

#include <algorithm>
#include <stdexcept>

namespace flightgear
{

namespace
{

using namespace osgGeoFX;

/// The numbers at the beginning of a line, and what is behind them.
std::vector<double> numbersOf(const std::string& line, std::size_t count, std::string& rest)
{
    std::size_t end = 0;
    for (std::size_t i = 0; i < count && end != std::string::npos; ++i)
        end = line.find(',', i == 0 ? 0 : end + 1);
    const auto numbers = parseNumbers(line.substr(0, end));
    if (!numbers || numbers->size() != count)
        throw std::runtime_error("\"" + line + "\" must begin with " + std::to_string(count) +
                                 " numbers, with commas between them.");
    rest = end == std::string::npos ? std::string() : line.substr(end + 1);
    return *numbers;
}

} // namespace

osg::ref_ptr<Effect> makeEffect(const std::string& line)
{
    std::string error;
    const osg::ref_ptr<Effect> effect = parseEffect(line, error);
    if (!effect) throw std::runtime_error("--effect: " + error);
    if (auto* map = dynamic_cast<PanoramaMap*>(effect.get()))
        map->setCoverUnit(static_cast<int>(Ground::coverUnit));
    return effect;
}

osg::ref_ptr<Effect> makeCloseUps(const std::vector<std::string>& lines)
{
    const osg::ref_ptr<CloseUps> closeUps = new CloseUps;
    for (const std::string& line : lines)
    {
        std::string rest;
        const std::vector<double> numbers = numbersOf(line, 5, rest);
        const osg::ref_ptr<CloseUp> closeUp = new CloseUp;
        RegionOfInterest& region = *closeUp->getRegion();
        if (!region.setGeodeticCenter(osg::DegreesToRadians(numbers[0]), osg::DegreesToRadians(numbers[1])) ||
            !region.setSize(numbers[2], numbers[2]) ||
            !closeUp->setOffset(osg::Vec3d(0.0, 0.0, numbers[3])) ||
            !closeUp->setScale(numbers[4], numbers[4], numbers[4]))
            throw std::runtime_error("--closeup " + line + ": a number is out of range.");
        closeUps->addCloseUp(closeUp);
    }
    return closeUps;
}

osg::ref_ptr<Effect> makeMapping(const std::string& line)
{
    std::string file;
    const std::vector<double> numbers = numbersOf(line, 4, file);
    const osg::ref_ptr<osg::Image> picture = osgDB::readRefImageFile(file);
    if (!picture) throw std::runtime_error("--mapping: \"" + file + "\" is no picture; name another file.");
    return makeMapping(numbers[0], numbers[1], numbers[2], numbers[3], *picture);
}

osg::ref_ptr<Effect> makeMapping(double longitude, double latitude, double width, double heading,
                                 osg::Image& picture)
{
    const osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
    const osg::ref_ptr<ProjectiveMappings> mappings = new ProjectiveMappings;
    const double height = width * picture.t() / std::max(picture.s(), 1);
    if (!mappings->setGeodeticOrigin(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude)) ||
        !mapping->setRectangle(osg::Vec2d(), 0.5 * width, 0.5 * height, osg::DegreesToRadians(heading)))
        throw std::runtime_error("--mapping: a number is out of range.");
    mapping->setLayer(new DataLayer(&picture));
    mapping->setOpacity(0.75);
    mappings->addMapping(mapping);
    return mappings;
}

} // namespace flightgear
