// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Mappings for the ground alone: buildings that stand in them show nothing of them.
#include <osgGeoFX/effect/RigidParts.h>
#include <osgGeoFX/mapping/ProjectiveMappings.h>
#include <tools/BentGround.h>

#include <cstring>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

class GroundOnly : public BentGround
{
protected:
    static osg::ref_ptr<osg::Geometry> makeBuilding()
    {
        osg::ref_ptr<osg::Geometry> box = makeBox(26.0f);
        RigidParts::finish(*box, std::vector<osg::Vec3>(box->getVertexArray()->getNumElements()));
        box->getOrCreateStateSet()->setDefine(RigidParts::define);
        return box;
    }
    osg::ref_ptr<osg::Image> picture(ProjectiveMappings* paint, bool building)
    {
        const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
        if (paint) scene->addEffect(paint);
        if (building) scene->addChild(makeBuilding());
        return render(scene);
    }
};

} // namespace

TEST_F(GroundOnly, BuildingsShowNothing)
{
    const osg::ref_ptr<ProjectiveMappings> all = makePaint(), ground = makePaint();
    EXPECT_FALSE(all->getGroundOnly());
    ASSERT_TRUE(ground->setGroundOnly(true));
    const osg::ref_ptr<osg::Image> bare = picture(nullptr, false), without = picture(nullptr, true),
                                   painted = picture(all, true), restrained = picture(ground, true);
    int box = 0, boxPainted = 0, boxRestrained = 0, otherApart = 0, otherPainted = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i)
    {
        const auto same = [&](const osg::Image& a, const osg::Image& b)
        {
            return std::memcmp(a.data() + 4 * i, b.data() + 4 * i, 3) == 0;
        };
        if (!same(*bare, *without))
        {
            ++box;
            boxPainted += same(*without, *painted) ? 0 : 1;
            boxRestrained += same(*without, *restrained) ? 0 : 1;
            continue;
        }
        otherPainted += same(*without, *painted) ? 0 : 1;
        otherApart += same(*painted, *restrained) ? 0 : 1;
    }
    EXPECT_GT(box, 300);
    EXPECT_GT(boxPainted, box * 9 / 10);
    EXPECT_EQ(boxRestrained, 0);
    EXPECT_GT(otherPainted, 300);
    EXPECT_EQ(otherApart, 0);
}
