// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// An application's programs with the effects' functions while effects change: no program changes that a thread may be drawing
// with, and each scene that draws with one draws its own effects.
#include <tools/BentGround.h>
#include <tools/ThreadedViews.h>

#include <osgGeoFX/deformation/VerticalExaggeration.h>

#include <chrono>
#include <condition_variable>
#include <mutex>

using namespace osgGeoFX;
using namespace geofx::test;

namespace
{

/// Draws colors as they are.
osg::ref_ptr<osg::Program> makeCalling(EffectScene& scene)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(
        new osg::Shader(osg::Shader::VERTEX,
                        "#version 330 compatibility\n"
                        "vec4 geofx_vertex(vec4 eyePosition);\n"
                        "void main()\n{\n"
                        "    vec4 eye = gl_ModelViewMatrix * gl_Vertex;\n"
                        "    vec4 deformed = geofx_vertex(eye);\n"
                        "    gl_Position = deformed == eye ? ftransform() : gl_ProjectionMatrix * deformed;\n"
                        "    gl_FrontColor = gl_Color;\n}\n"));
    program->addShader(new osg::Shader(osg::Shader::FRAGMENT,
                                       "#version 330 compatibility\n"
                                       "vec4 geofx_fragment(vec4 color, vec4 map);\n"
                                       "void main() { gl_FragColor = geofx_fragment(gl_Color, "
                                       "vec4(0.0)); }\n"));
    scene.addFunctions(*program);
    return program;
}

osg::ref_ptr<VerticalExaggeration> makeLift()
{
    osg::ref_ptr<VerticalExaggeration> lift = new VerticalExaggeration;
    lift->setFactor(4.0);
    return lift;
}

/// What a program draws with.
std::vector<std::string> textsOf(const osg::Program& program)
{
    std::vector<std::string> texts;
    for (unsigned int i = 0; i < program.getNumShaders(); ++i)
        texts.push_back(program.getShader(i)->getShaderSource());
    return texts;
}

/// Where a thread that draws waits until the next frame has been culled.
struct Meeting
{
    std::mutex mutex;
    std::condition_variable moved;
    // Under the lock.
    bool drawing = false, changed = false, culled = false;
    int drawn = 0, awaited = -1; ///< frames that have been drawn; the one in which the thread waits
    int changes = -1;            ///< of what is drawn with; -1 before it is known

    bool wait(bool Meeting::*what)
    {
        std::unique_lock<std::mutex> lock(mutex);
        return moved.wait_for(lock, std::chrono::seconds(20), [&] { return this->*what; });
    }
    void tell(bool Meeting::*what)
    {
        const std::lock_guard<std::mutex> lock(mutex);
        this->*what = true;
        moved.notify_all();
    }
};

class WaitingDraw : public osg::Drawable::DrawCallback
{
public:
    explicit WaitingDraw(Meeting& meeting) : _meeting(meeting) {}
    void drawImplementation(osg::RenderInfo& info, const osg::Drawable* drawable) const override
    {
        bool waits = false;
        {
            const std::lock_guard<std::mutex> lock(_meeting.mutex);
            waits = ++_meeting.drawn == _meeting.awaited;
        }
        if (waits)
        {
            const auto* applied = info.getState()->getLastAppliedProgramObject();
            ASSERT_TRUE(applied);
            const osg::Program& program = *applied->getProgram();
            const std::vector<std::string> before = textsOf(program);
            _meeting.tell(&Meeting::drawing);
            EXPECT_TRUE(_meeting.wait(&Meeting::culled));
            const bool relinked = applied->needsLink();
            _meeting.changes = (textsOf(program) == before ? 0 : 1) + (relinked ? 1 : 0);
        }
        drawable->drawImplementation(info);
    }

private:
    Meeting& _meeting;
};

/// Tells when the scene below it has been culled with the new effects.
class TellingCull : public osg::NodeCallback
{
public:
    explicit TellingCull(Meeting& meeting) : _meeting(meeting) {}
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        traverse(node, visitor);
        bool changed = false;
        {
            const std::lock_guard<std::mutex> lock(_meeting.mutex);
            changed = _meeting.changed;
        }
        if (changed) _meeting.tell(&Meeting::culled);
    }

private:
    Meeting& _meeting;
};

class FollowingProgramsTest : public BentGround
{
};

} // namespace

// The draw thread is in the middle of a frame while the next one, with another list of effects, is culled.
TEST_F(FollowingProgramsTest, NothingThatIsBeingDrawnChanges)
{
    for (const ThreadedViews::Threading model :
         {osgViewer::ViewerBase::DrawThreadPerContext,
          osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext})
    {
        SCOPED_TRACE(model);
        Meeting meeting;
        const osg::ref_ptr<osg::Geometry> ground = makeGround();
        const osg::ref_ptr<EffectScene> scene = makeScene({ground});
        ground->getOrCreateStateSet()->setAttribute(makeCalling(*scene));
        ground->setDrawCallback(new WaitingDraw(meeting));
        const osg::ref_ptr<osg::Group> root = makePlain({scene});
        root->setCullCallback(new TellingCull(meeting));
        osg::ref_ptr<osg::Image> after;
        {
            ThreadedViews views(model);
            views.add(root, *viewer().getCamera());
            views.realize();
            views.pictures();
            {
                // Not in an earlier frame that is still to be drawn: the second one after it is not culled before its end.
                const std::lock_guard<std::mutex> lock(meeting.mutex);
                meeting.awaited = views.frames() + 1;
            }
            views.frame();
            ASSERT_TRUE(meeting.wait(&Meeting::drawing));
            scene->addEffect(makeLift());
            meeting.tell(&Meeting::changed);
            views.frame();
            after = views.pictures().front();
        }
        EXPECT_EQ(meeting.changes, 0);
        ground->setDrawCallback(nullptr);
        const osg::ref_ptr<EffectScene> fresh = makeScene({makeGround()});
        fresh->addEffect(makeLift());
        ASSERT_TRUE(after);
        EXPECT_TRUE(same(*after, *render(fresh)));
    }
}

// Functions of one scene; drawn by that, by another one, and by OSG alone.
TEST_F(FollowingProgramsTest, EachSceneDrawsItsOwnEffects)
{
    const osg::ref_ptr<osg::Geometry> ground = makeGround();
    const osg::ref_ptr<EffectScene> first = makeScene({ground});
    const osg::ref_ptr<osg::Program> program = makeCalling(*first);
    ground->getOrCreateStateSet()->setAttribute(program);
    const std::vector<std::string> given = textsOf(*program);
    const osg::ref_ptr<EffectScene> second = new EffectScene;
    second->addEffect(makeLift());
    second->addEffect(makeBend());
    second->addChild(ground);
    const osg::ref_ptr<EffectScene> other = new EffectScene;
    other->addEffect(makeLift());
    other->addEffect(makeBend());
    other->addChild(makeGround());
    const osg::ref_ptr<osg::Image> bent = render(makeScene({makeGround()}));
    const osg::ref_ptr<osg::Image> both = render(other);
    const osg::ref_ptr<osg::Image> plain = render(makePlain({makeGround()}));
    EXPECT_GT(differing(*bent, *both), 100);
    for (int turn = 0; turn < 2; ++turn)
    {
        EXPECT_TRUE(same(*render(first), *bent));
        EXPECT_TRUE(same(*render(second), *both));
        EXPECT_TRUE(same(*render(makePlain({ground})), *plain));
    }
    EXPECT_TRUE(textsOf(*program) == given);
    // Who adds them again, or those of another scene, changes nothing.
    second->addFunctions(*program);
    EXPECT_TRUE(textsOf(*program) == given);
}

// What the application changes in its program comes with the next frame, whatever it was put into force by.
TEST_F(FollowingProgramsTest, CopiesFollowTheirProgram)
{
    const auto build = []
    {
        const osg::ref_ptr<EffectScene> scene = makeScene({makeGround()});
        scene->addEffect(makeLift());
        return scene;
    };
    const osg::ref_ptr<osg::Image> expected = render(build());
    constexpr unsigned int on = osg::StateAttribute::ON;
    for (const unsigned int flags :
         {on, on | osg::StateAttribute::OVERRIDE, on | osg::StateAttribute::PROTECTED,
          on | osg::StateAttribute::OVERRIDE | osg::StateAttribute::PROTECTED})
    {
        SCOPED_TRACE(flags);
        const osg::ref_ptr<EffectScene> scene = build();
        // Before its effects are known.
        const osg::ref_ptr<EffectScene> empty = new EffectScene;
        const osg::ref_ptr<osg::Program> program = makeCalling(*empty);
        scene->getChild(0)->getOrCreateStateSet()->setAttribute(program, flags);
        EXPECT_TRUE(same(*render(scene), *expected));
        osg::ref_ptr<osg::Shader> own;
        for (unsigned int i = 0; i < program->getNumShaders(); ++i)
        {
            if (program->getShader(i)->getShaderSource().find("gl_FragColor") != std::string::npos)
                own = program->getShader(i);
        }
        ASSERT_TRUE(own);
        const osg::ref_ptr<osg::Shader> magenta =
            new osg::Shader(osg::Shader::FRAGMENT, "#version 330 compatibility\n"
                                                   "void main() { gl_FragColor = vec4(1, 0, 1, 1); }\n");
        program->removeShader(own);
        program->addShader(magenta);
        const osg::ref_ptr<osg::Image> changed = render(scene);
        EXPECT_EQ(differing(*changed, *expected), covered(*expected));
        EXPECT_EQ(covered(*changed), covered(*expected));
        magenta->setShaderSource(
            "#version 330 compatibility\nvoid main() { gl_FragColor = vec4(0, 1, 0, 1); }\n");
        EXPECT_EQ(differing(*changed, *render(scene)), covered(*expected));
        program->removeShader(magenta);
        program->addShader(own);
        EXPECT_TRUE(same(*render(scene), *expected));
    }
}
