// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What classes of land cover mean where their table does not say so.
#include <osgGeoFX/geodata/LandCoverTable.h>
#include <osgGeoFX/geodata/detail/BakedLegends.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>

namespace osgGeoFX
{

namespace
{

struct KnownClass
{
    const char* id;
    double trees, town, bare;
    bool water;
};

// The classes of data/oahu. Its scrub covers what are forests in truth.
constexpr KnownClass KNOWN_CLASSES[] = {
    {"sea", 0.0, 0.0, 0.0, true},           {"lake", 0.0, 0.0, 0.0, true},
    {"river", 0.0, 0.0, 0.0, true},         {"canal", 0.0, 0.0, 0.0, true},
    {"marsh", 0.05, 0.0, 0.0, false},       {"sand", 0.0, 0.0, 0.5, false},
    {"lava", 0.0, 0.0, 0.5, false},         {"bare_ground", 0.0, 0.0, 0.5, false},
    {"grassland", 0.05, 0.0, 0.0, false},   {"scrub", 0.55, 0.0, 0.0, false},
    {"mixed_forest", 0.9, 0.0, 0.0, false}, {"crops", 0.03, 0.0, 0.0, false},
    {"golf_course", 0.25, 0.0, 0.0, false}, {"cemetery", 0.15, 0.0, 0.0, false},
    {"town", 0.2, 0.6, 0.0, false},         {"urban", 0.05, 1.0, 0.0, false},
    {"industrial", 0.02, 0.8, 0.0, false},  {"paved", 0.0, 0.3, 0.0, false},
    {"road", 0.1, 0.3, 0.0, false},         {"freeway", 0.0, 0.3, 0.0, false},
    {"railroad", 0.1, 0.1, 0.0, false},     {"airfield_grass", 0.0, 0.0, 0.0, false},
    {"apron", 0.0, 0.1, 0.0, false},        {"runway", 0.0, 0.0, 0.0, false},
};

std::string lowerCase(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

std::map<std::string, LandCoverClass> legendClasses()
{
    std::map<std::string, LandCoverClass> result;
    // Legends have all columns, so that reading them asks for nothing from here.
    for (const std::string& name : readyLegends())
        for (const LandCoverClass& entry : readLandCoverTable(name))
            result.emplace(lowerCase(entry.id), entry);
    return result;
}

} // namespace

void coverOfClass(LandCoverClass& entry)
{
    const std::string id = lowerCase(entry.id);
    for (const KnownClass& known : KNOWN_CLASSES)
        if (id == known.id)
        {
            entry.trees = known.trees;
            entry.town = known.town;
            entry.bare = known.bare;
            entry.water = known.water;
            return;
        }
    static const std::map<std::string, LandCoverClass> ofLegends = legendClasses();
    const auto found = ofLegends.find(id);
    if (found == ofLegends.end()) return;
    entry.trees = found->second.trees;
    entry.town = found->second.town;
    entry.bare = found->second.bare;
    entry.water = found->second.water;
}

const BakedLegend* findLegend(const std::string& name)
{
    const auto* end = bakedLegends + bakedLegendCount;
    const auto* found =
        std::find_if(bakedLegends, end, [&](const auto& legend) { return name == legend.name; });
    return found == end ? nullptr : found;
}

std::vector<std::string> readyLegends()
{
    std::vector<std::string> names;
    for (std::size_t i = 0; i < bakedLegendCount; ++i)
        names.emplace_back(bakedLegends[i].name);
    return names;
}

std::string landCoverTableText(const std::string& file)
{
    if (const BakedLegend* legend = findLegend(file)) return legend->text;
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

} // namespace osgGeoFX
