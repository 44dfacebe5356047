// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// How long an effect's data of a camera and a scene lives.
#include <osgGeoFX/effect/PerCamera.h>

#include <gtest/gtest.h>

using namespace osgGeoFX;

namespace
{

int alive = 0;

struct Counted
{
    Counted() { ++alive; }
    ~Counted() { --alive; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;

    int mark = 0;
};

using Data = PerCamera<Counted, osg::Referenced>;

} // namespace

TEST(PerCameraTest, ForgetsAnOwnerThatIsGone)
{
    Data data;
    const osg::ref_ptr<osg::Referenced> other = new osg::Referenced;
    osg::ref_ptr<osg::Referenced> owner = new osg::Referenced;
    data.of(*owner);
    owner = nullptr;
    data.of(*other);
    EXPECT_EQ(alive, 1);
}

// An effect that goes from scene to scene, with one camera.
TEST(PerCameraTest, ForgetsScenesThatAreGone)
{
    Data data;
    const osg::ref_ptr<osg::Referenced> owner = new osg::Referenced;
    for (int i = 0; i < 20; ++i)
    {
        const osg::ref_ptr<osg::Group> scene = new osg::Group;
        // Another scene may have come to the address of the former one.
        EXPECT_EQ(data.of(*owner, *scene).mark, 0) << i;
        data.of(*owner, *scene).mark = 1;
        EXPECT_EQ(data.of(*owner, *scene).mark, 1) << i;
        EXPECT_EQ(alive, 1) << i;
    }
    data.of(*owner);
    EXPECT_EQ(alive, 1) << "what belongs to no scene";
}

// The other owner's last frame may still be on its way to the screen.
TEST(PerCameraTest, KeepsTheDataOfASceneUntilItsOwnOwnerAsks)
{
    Data data;
    const osg::ref_ptr<osg::Referenced> first = new osg::Referenced, second = new osg::Referenced;
    osg::ref_ptr<osg::Group> former = new osg::Group;
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    data.of(*first, *former);
    former = nullptr;
    data.of(*second, *scene);
    EXPECT_EQ(alive, 2);
    data.of(*first, *scene);
    EXPECT_EQ(alive, 2);
    data.of(*first, *scene);
    data.of(*second, *scene);
    EXPECT_EQ(alive, 2);
}

TEST(PerCameraTest, ForgetsASceneOnDemand)
{
    Data data;
    const osg::ref_ptr<osg::Referenced> owner = new osg::Referenced, other = new osg::Referenced;
    const osg::ref_ptr<osg::Group> scene = new osg::Group, kept = new osg::Group;
    data.of(*owner, *scene);
    data.of(*other, *scene);
    data.of(*owner, *kept).mark = 1;
    data.of(*owner).mark = 2;
    data.forget(*scene);
    EXPECT_EQ(alive, 2);
    EXPECT_EQ(data.of(*owner, *kept).mark, 1);
    EXPECT_EQ(data.of(*owner).mark, 2);
}
