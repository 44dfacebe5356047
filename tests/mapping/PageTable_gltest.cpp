// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// The texture of the table of pages in a context.
#include <osgGeoFX/mapping/detail/PageTable.h>
#include <tools/GlFixture.h>

#include <memory>
#include <vector>

using namespace osgGeoFX;

namespace
{

class PageTableTexture : public geofx::test::GlFixture
{
protected:
    PageTableTexture() : GlFixture(16, 16) {}
};

} // namespace

TEST_F(PageTableTexture, OutlivesTheTable)
{
    auto table = std::make_unique<PageTable>();
    ASSERT_TRUE(table->write({{{3, 0, 0}, {3, 0, 0}, 5}, {{3, 4, 2}, {3, 4, 2}, 6}}, 4));
    const int cells = table->cells();
    std::vector<std::uint32_t> expected;
    for (int row = 0; row < cells; ++row)
    {
        for (int column = 0; column < cells; ++column)
            expected.push_back(table->word(column, row));
    }
    // A frame that is still being drawn has the texture when its effect is gone.
    const osg::ref_ptr<osg::Texture2D> texture = table->texture();
    table.reset();
    std::vector<std::uint32_t> found(expected.size());
    withContext(
        [&](osg::State& state)
        {
            texture->apply(state);
            glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, 0x8367, found.data());
            texture->releaseGLObjects(&state);
        });
    EXPECT_EQ(found, expected);
}
