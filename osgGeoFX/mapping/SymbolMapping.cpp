// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/mapping/SymbolMapping.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>

namespace osgGeoFX
{

namespace
{

struct Band
{
    double nearest, farthest, softness;
};

/// What lets the images of a look go over into each other: a mapping's softness counts at both of its ends, so each band's
/// is chosen for its near end to rise just where the one before falls.
std::vector<Band> bandsOf(const SymbolMapping::Look& look)
{
    std::vector<Band> bands;
    double nearest = look.nearest;
    double softness = look.softness;
    for (const SymbolMapping::Level& level : look.levels)
    {
        bands.push_back({nearest, level.farthest, softness});
        nearest = level.farthest * (1.0 + softness);
        softness /= 1.0 + softness;
    }
    return bands;
}

bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

const char* faultOf(const SymbolMapping::Look& look)
{
    if (look.levels.empty()) return "no images";
    for (const SymbolMapping::Level& level : look.levels)
    {
        if (!level.layer) return "a level without an image";
    }
    if (!within(look.width, 1e-3, 1e7) || !within(look.stretch, 0.01, 100.0)) return "a size out of range";
    if (!within(look.pixels, 0.0, 1e5)) return "a size in pixels out of range";
    if (!within(look.softness, 0.0, 1.0) || !within(look.opacity, 0.0, 1.0)) return "a share out of 0…1";
    if (!within(look.order, -1000, 1000)) return "an order out of −1000…1000";
    for (const Band& band : bandsOf(look))
    {
        if (!within(band.nearest, 0.0, 5e7) || !within(band.farthest, band.nearest, 5e7))
            return "distances that do not grow enough";
    }
    return nullptr;
}

} // namespace

SymbolMapping::SymbolMapping(ProjectiveMappings& mappings) : _host(&mappings), _transfer(new ColorTransfer) {}

SymbolMapping::~SymbolMapping()
{
    clear();
}

std::optional<int> SymbolMapping::addLook(const Look& look)
{
    if (const char* fault = faultOf(look))
    {
        OSG_WARN << "osgGeoFX: SymbolMapping got a look with " << fault << "; it is not added." << std::endl;
        return std::nullopt;
    }
    _looks.push_back(look);
    return static_cast<int>(_looks.size()) - 1;
}

bool SymbolMapping::put(const Symbol& symbol, const osg::Vec3d& place, double heading) const
{
    if (!within(place.x(), -5e7, 5e7) || !within(place.y(), -5e7, 5e7) || !within(place.z(), -12000.0, 1e7) ||
        !std::isfinite(heading))
    {
        OSG_WARN << "osgGeoFX: SymbolMapping got the place " << place.x() << ", " << place.y() << ", "
                 << place.z() << " with the heading " << heading << "; nothing changes." << std::endl;
        return false;
    }
    const Look& look = _looks[static_cast<std::size_t>(symbol.look)];
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : symbol.mappings)
    {
        mapping->setRectangle({place.x(), place.y()}, look.width / 2.0, look.width * look.stretch / 2.0,
                              heading);
        mapping->setHeight(place.z());
    }
    return true;
}

std::optional<int> SymbolMapping::add(int number, const osg::Vec3d& place, double heading)
{
    if (number < 0 || number >= static_cast<int>(_looks.size()))
    {
        OSG_WARN << "osgGeoFX: SymbolMapping has no look " << number << "; the symbol is not added."
                 << std::endl;
        return std::nullopt;
    }
    const Look& look = _looks[static_cast<std::size_t>(number)];
    const std::vector<Band> bands = bandsOf(look);
    Symbol symbol{number, {}};
    for (std::size_t i = 0; i < bands.size(); ++i)
    {
        osg::ref_ptr<ProjectiveMapping> mapping = new ProjectiveMapping;
        mapping->setTransfer(_transfer);
        mapping->setLayer(look.levels[i].layer);
        mapping->setOrder(look.order);
        mapping->setOpacity(look.opacity);
        mapping->setSizeInPixels(look.pixels * std::sqrt(look.stretch));
        mapping->setTurned(look.turned);
        mapping->setDistances(bands[i].nearest, bands[i].farthest, bands[i].softness);
        symbol.mappings.push_back(mapping);
    }
    if (!put(symbol, place, heading)) return std::nullopt;
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : symbol.mappings)
        _host->addMapping(mapping);
    _symbols[_next] = symbol;
    return _next++;
}

bool SymbolMapping::move(int number, const osg::Vec3d& place, double heading)
{
    const auto found = _symbols.find(number);
    return found != _symbols.end() && put(found->second, place, heading);
}

bool SymbolMapping::setEnabled(int number, bool enabled)
{
    const auto found = _symbols.find(number);
    if (found == _symbols.end()) return false;
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : found->second.mappings)
        mapping->setEnabled(enabled);
    return true;
}

void SymbolMapping::take(const Symbol& symbol)
{
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : symbol.mappings)
        _host->removeMapping(mapping);
}

bool SymbolMapping::remove(int number)
{
    const auto found = _symbols.find(number);
    if (found == _symbols.end()) return false;
    take(found->second);
    _symbols.erase(found);
    return true;
}

void SymbolMapping::clear()
{
    for (const auto& [number, symbol] : _symbols)
        take(symbol);
    _symbols.clear();
}

std::optional<int> SymbolMapping::symbolOf(const ProjectiveMapping& mapping) const
{
    for (const auto& [number, symbol] : _symbols)
    {
        if (std::find(symbol.mappings.begin(), symbol.mappings.end(), &mapping) != symbol.mappings.end())
            return number;
    }
    return std::nullopt;
}

std::vector<ProjectiveMapping*> SymbolMapping::mappings(int number) const
{
    std::vector<ProjectiveMapping*> result;
    const auto found = _symbols.find(number);
    if (found == _symbols.end()) return result;
    for (const osg::ref_ptr<ProjectiveMapping>& mapping : found->second.mappings)
        result.push_back(mapping);
    return result;
}

} // namespace osgGeoFX
