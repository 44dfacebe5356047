// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/effect/detail/ProfileProgram.h>

#include <osg/DisplaySettings>
#include <osg/State>

#include <gtest/gtest.h>

using osgGeoFX::ProfileProgram;

namespace
{

/// A program, and for how many contexts OSG has made room in it.
class RoomyProgram : public ProfileProgram
{
public:
    RoomyProgram() = default;
    unsigned int room() const { return _pcpList.size(); }
};

/// The same for a shader.
class RoomyShader : public osg::Shader
{
public:
    RoomyShader() : osg::Shader(osg::Shader::VERTEX, "#version 330 compatibility\nvoid main() {}\n") {}
    unsigned int room() const { return _pcsList.size(); }
};

} // namespace

// OSG makes room without a lock, and draw threads of other contexts may draw with these programs.
TEST(ProgramContexts, AContextThatClosesLeavesProgramsAloneThatItHasNothingOf)
{
    osg::DisplaySettings& settings = *osg::DisplaySettings::instance();
    const unsigned int before = settings.getMaxNumberOfGraphicsContexts();
    settings.setMaxNumberOfGraphicsContexts(1);
    const osg::ref_ptr<RoomyProgram> program = new RoomyProgram;
    const osg::ref_ptr<RoomyShader> shader = new RoomyShader;
    program->addShader(shader);
    program->core();
    settings.setMaxNumberOfGraphicsContexts(before);

    const osg::ref_ptr<osg::State> other = new osg::State;
    other->setContextID(7);
    ProfileProgram::releaseAll(*other);
    EXPECT_EQ(program->room(), 1u);
    EXPECT_EQ(shader->room(), 1u);
}
