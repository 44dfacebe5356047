// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include "CloseUpSuite.h"
#include "DeformationSuite.h"
#include "FlightSuite.h"
#include "LabelsSuite.h"
#include "LinesSuite.h"
#include "MappingSuite.h"
#include "OsgEarthSuite.h"
#include "PanoramaSuite.h"
#include "SoakSuite.h"
#include "Suite.h"
#include "TerrainSuite.h"

#include <algorithm>
#include <iostream>

namespace geofx::bench
{

const std::vector<Suite>& suites()
{
    static const std::vector<Suite> all = {
        terrainSuite(), deformationSuite(), mappingSuite(),  closeUpSuite(), panoramaSuite(),
        labelsSuite(),  linesSuite(),       osgEarthSuite(), flightSuite(),  soakSuite()};
    return all;
}

const Suite* findSuite(const std::string& name)
{
    const auto found = std::find_if(suites().begin(), suites().end(),
                                    [&](const Suite& suite) { return suite.name == name; });
    return found == suites().end() ? nullptr : &*found;
}

bool Settings::wants(const std::string& group) const
{
    return only.empty() || std::find(only.begin(), only.end(), group) != only.end();
}

void announce(const std::string& text)
{
    std::cerr << "osggeofx_bench: " << text << std::endl;
}

} // namespace geofx::bench
