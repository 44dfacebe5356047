// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// What the programs make of awkward files: exit codes, pictures, and each line that they print.
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <strangers/StrangerRun.h>
#include <tools/GeofxPlugins.h>

using namespace geofx::test;
using namespace geofx::test::strangers;

namespace
{

class StrangerPrograms : public GeofxPlugins, public testing::WithParamInterface<std::string>
{
};

INSTANTIATE_TEST_SUITE_P(Of, StrangerPrograms, testing::ValuesIn(collections(true)),
                         [](const auto& each) { return each.param; });

} // namespace

TEST_P(StrangerPrograms, ComeOutRightOrSayWhyNot)
{
    askAll(GetParam());
}
