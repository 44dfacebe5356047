// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Awkward files of other programs and of people: what must come out of each, as numbers and sentences, and not a word more.
#include <osgGeoFX/geodata/detail/RasterSource.h>
#include <strangers/StrangerRun.h>
#include <tools/GeofxPlugins.h>

#include <set>

using namespace geofx::test;
using namespace geofx::test::strangers;

namespace
{

class Strangers : public GeofxPlugins, public testing::WithParamInterface<std::string>
{
};

INSTANTIATE_TEST_SUITE_P(Of, Strangers, testing::ValuesIn(collections(false)),
                         [](const auto& each) { return each.param; });

} // namespace

TEST_P(Strangers, ComeOutRightOrSayWhyNot)
{
    askAll(GetParam());
}

TEST(StrangerFiles, AreManyAndHaveNamesOfTheirOwn)
{
    std::set<std::string> names;
    for (const std::string& collection : collections())
        for (const Stranger& each : readCollection(collection))
        {
            EXPECT_TRUE(names.insert(collection + " " + each.name).second) << each.name;
            EXPECT_TRUE(std::any_of(each.steps.begin(), each.steps.end(),
                                    [](const StrangerStep& step) { return step.isAsked; }))
                << each.name << " has no answer";
        }
    EXPECT_GE(names.size(), 150u);
}

TEST(StrangerFiles, AnswersAreComparedAsTheyShould)
{
    EXPECT_TRUE(isAnswer("1 2 x", "1 2 x"));
    EXPECT_FALSE(isAnswer("1 2 x", "1 2"));
    EXPECT_TRUE(isAnswer("10.4 \"a b\"", "10~0.5 \"a b\""));
    EXPECT_FALSE(isAnswer("10.6 \"a b\"", "10~0.5 \"a b\""));
    EXPECT_TRUE(isAnswer("! a.tif: it is bad.", "! a.tif: … bad."));
    EXPECT_FALSE(isAnswer("! a.tif: it is bad. So.", "! a.tif: … bad."));
    EXPECT_TRUE(isAnswer("1.0000001", "1"));
    EXPECT_FALSE(isAnswer("1.001", "1"));
    EXPECT_FALSE(isAnswer("none", "0"));
}
