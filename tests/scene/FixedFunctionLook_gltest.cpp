// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
// Geometry without a shader looks below an EffectScene as OpenGL's fixed functions draw it.
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/scene/EffectScene.h>
#include <tools/LookFixture.h>

#include <osg/Fog>
#include <osg/Geode>
#include <osg/Geometry>
#include <osg/LightModel>
#include <osg/LineWidth>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osg/Point>
#include <osg/PointSprite>
#include <osg/Program>
#include <osg/ShadeModel>
#include <osg/ShapeDrawable>
#include <osg/TexEnv>
#include <osgText/Text>

#include <cstring>

class FixedFunctionLook : public geofx::test::LookFixture
{
};

TEST_F(FixedFunctionLook, Unlit)
{
    compare("vertex colors", [](const Place& place) { place.scene.addChild(makeWaves()); });
    compare("one color",
            [](const Place& place)
            {
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                osg::ref_ptr<osg::Vec4Array> color = new osg::Vec4Array;
                color->push_back({0.3f, 1.7f, 0.2f, 1});
                osg::ref_ptr<osg::Vec3Array> normal = new osg::Vec3Array;
                normal->push_back({0, 0, 1});
                waves->setColorArray(color, osg::Array::BIND_OVERALL);
                waves->setNormalArray(normal, osg::Array::BIND_OVERALL);
                place.scene.addChild(waves);
            });
    compare("no color",
            [](const Place& place)
            {
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->setColorArray(nullptr);
                waves->setNormalArray(nullptr);
                place.state().setAttribute(makeMaterial(0));
                place.scene.addChild(waves);
            });
    compare("flat",
            [](const Place& place)
            {
                place.state().setAttribute(new osg::ShadeModel(osg::ShadeModel::FLAT));
                place.scene.addChild(makeWaves());
            });
    compare("secondary color",
            [](const Place& place)
            {
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->setSecondaryColorArray(waves->getNormalArray(), osg::Array::BIND_PER_VERTEX);
                place.state().setMode(0x8458, on); // GL_COLOR_SUM
                place.scene.addChild(waves);
            });
}

TEST_F(FixedFunctionLook, Lights)
{
    compare("lighting without a lamp",
            [](const Place& place)
            {
                place.state().setMode(GL_LIGHTING, on);
                place.scene.addChild(makeWaves());
            });
    compare("one directional",
            [](const Place& place)
            {
                addSun(place);
                place.scene.addChild(makeWaves());
            });
    compare(
        "three, one with attenuation, one spot",
        [](const Place& place)
        {
            addSun(place);
            const osg::ref_ptr<osg::Light> lamp = addLight(place, 1, {2, -2, 3, 1});
            lamp->setConstantAttenuation(0.4f);
            lamp->setLinearAttenuation(0.1f);
            lamp->setQuadraticAttenuation(0.05f);
            const osg::ref_ptr<osg::Light> spot = addLight(place, 2, {-4, -2, 8, 2});
            spot->setDirection({0.2f, 0.3f, -1});
            spot->setSpotCutoff(35);
            spot->setSpotExponent(3);
            place.state().setAttribute(makeMaterial(12));
            place.scene.addChild(makeWaves());
        },
        2); // pow() of a shininess and an exponent
    compare("the last lamp alone",
            [](const Place& place)
            {
                addLight(place, 7, {0, -1, 1, 0});
                place.scene.addChild(makeWaves());
            });
    compare("the viewer's headlight",
            [this](const Place& place)
            {
                viewer().setLightingMode(osg::View::HEADLIGHT);
                place.scene.addChild(makeWaves());
            });
    viewer().setLightingMode(osg::View::NO_LIGHT);
    compare("a lamp below the scene",
            [](const Place& place)
            {
                place.scene.addChild(makeWaves());
                addSun({place.scene, place.scene});
            });
    compare("switched off for some",
            [](const Place& place)
            {
                addSun(place);
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->getOrCreateStateSet()->setMode(GL_LIGHTING, off);
                place.scene.addChild(waves);
                osg::ref_ptr<osg::MatrixTransform> aside =
                    new osg::MatrixTransform(osg::Matrix::translate(2, 2, 1));
                aside->addChild(makeWaves());
                place.scene.addChild(aside);
            });
}

TEST_F(FixedFunctionLook, Materials)
{
    const auto lit =
        [](float shininess, osg::Material::ColorMode mode, const osg::ref_ptr<osg::LightModel>& model)
    {
        return [=](const Place& place)
        {
            addSun(place);
            addLight(place, 1, {3, -6, 4, 1});
            place.state().setAttribute(makeMaterial(shininess, mode));
            if (model) place.state().setAttribute(model);
            place.scene.addChild(makeWaves());
        };
    };
    // pow() of the shininess: two of 255.
    compare("shining", lit(40, osg::Material::OFF, nullptr), 2);
    compare("shininess 0", lit(0, osg::Material::OFF, nullptr), 2);
    compare("color is ambient", lit(8, osg::Material::AMBIENT, nullptr), 2);
    compare("color is diffuse", lit(8, osg::Material::DIFFUSE, nullptr), 2);
    compare("color is ambient and diffuse", lit(8, osg::Material::AMBIENT_AND_DIFFUSE, nullptr), 2);
    compare("color is specular", lit(8, osg::Material::SPECULAR, nullptr), 2);
    compare("color is emission", lit(8, osg::Material::EMISSION, nullptr), 2);

    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity({0.4f, 0.1f, 0.3f, 1});
    model->setLocalViewer(true);
    compare("local viewer", lit(20, osg::Material::OFF, model), 2);
    model = new osg::LightModel;
    model->setColorControl(osg::LightModel::SEPARATE_SPECULAR_COLOR);
    compare("separate specular", lit(20, osg::Material::OFF, model), 2);
    compare(
        "separate specular on a texture",
        [&](const Place& place)
        {
            lit(20, osg::Material::OFF, model)(place);
            addTexture(place.state(), 0, GL_RGB, osg::TexEnv::MODULATE);
        },
        2);
    for (const bool twoSided : {false, true})
    {
        model = new osg::LightModel;
        model->setTwoSided(twoSided);
        compare(
            twoSided ? "two-sided" : "one-sided from behind",
            [&](const Place& place)
            {
                // From the front and, turned over, from behind.
                lit(15, osg::Material::OFF, model)(place);
                osg::ref_ptr<osg::MatrixTransform> over = new osg::MatrixTransform(
                    osg::Matrix::rotate(osg::PI, osg::Vec3d(0, 1, 0)) * osg::Matrix::translate(3, 3, 1));
                over->addChild(makeWaves());
                place.scene.addChild(over);
            },
            2);
    }
}

TEST_F(FixedFunctionLook, Normals)
{
    const auto scaled = [](const osg::Vec3d& scale, GLenum mode)
    {
        return [=](const Place& place)
        {
            addSun(place);
            if (mode) place.state().setMode(mode, on);
            osg::ref_ptr<osg::MatrixTransform> transform =
                new osg::MatrixTransform(osg::Matrix::scale(scale));
            transform->addChild(makeWaves());
            place.scene.addChild(transform);
        };
    };
    compare("smaller, as they are", scaled({0.8, 0.8, 0.8}, 0));
    compare("larger, as they are", scaled({1.25, 1.25, 1.25}, 0));
    compare("normalised", scaled({0.6, 0.9, 1.4}, GL_NORMALIZE));
    compare("rescaled", scaled({0.7, 0.7, 0.7}, GL_RESCALE_NORMAL));
    compare("rescaled unevenly", scaled({0.7, 0.9, 1.2}, GL_RESCALE_NORMAL));
    compare("both",
            [&](const Place& place)
            {
                scaled({1.3, 0.8, 1.1}, GL_NORMALIZE)(place);
                place.state().setMode(GL_RESCALE_NORMAL, on);
            });
}

TEST_F(FixedFunctionLook, PointsAndLines)
{
    for (const GLenum primitive : {GL_LINES, GL_LINE_STRIP, GL_POINTS})
    {
        compare("primitive " + std::to_string(primitive),
                [=](const Place& place)
                {
                    addSun(place);
                    place.state().setAttribute(new osg::Point(3));
                    place.state().setAttribute(new osg::LineWidth(2));
                    place.scene.addChild(makeWaves(primitive));
                });
    }
    compare("points that get smaller",
            [](const Place& place)
            {
                osg::ref_ptr<osg::Point> point = new osg::Point(60);
                point->setDistanceAttenuation({0.2f, 0.3f, 1.1f});
                place.state().setAttribute(point);
                place.scene.addChild(makeWaves(GL_POINTS));
            });
    compare("point sprites",
            [](const Place& place)
            {
                addTexture(place.state(), 0, GL_RGB, osg::TexEnv::REPLACE);
                place.state().setTextureAttributeAndModes(0, new osg::PointSprite);
                place.state().setAttribute(new osg::Point(7));
                place.scene.addChild(makeWaves(GL_POINTS));
            });
}

TEST_F(FixedFunctionLook, Inheritance)
{
    compare("on a drawable, its Geode and parents",
            [](const Place& place)
            {
                addSun({place.above, place.above});
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->getOrCreateStateSet()->setAttribute(makeMaterial(0));
                osg::ref_ptr<osg::Geode> geode = new osg::Geode;
                geode->addDrawable(waves);
                addTexture(*geode->getOrCreateStateSet(), 0, GL_RGB, osg::TexEnv::BLEND);
                place.scene.addChild(geode);
                place.above.getOrCreateStateSet()->setAttributeAndModes(new osg::Fog);
                static_cast<osg::Fog*>(place.above.getStateSet()->getAttribute(osg::StateAttribute::FOG))
                    ->setDensity(0.04f);
            });
    compare("overridden and protected",
            [](const Place& place)
            {
                addSun(place);
                place.above.getOrCreateStateSet()->setMode(GL_LIGHTING, off | osg::StateAttribute::OVERRIDE);
                place.state().setAttribute(makeMaterial(0), overriding);
                place.scene.addChild(makeWaves());
                osg::ref_ptr<osg::Geometry> lit = makeWaves();
                lit->getOrCreateStateSet()->setMode(GL_LIGHTING, keeping);
                lit->getStateSet()->setAttribute(makeMaterial(5, osg::Material::DIFFUSE));
                osg::ref_ptr<osg::MatrixTransform> aside =
                    new osg::MatrixTransform(osg::Matrix::translate(3, 3, 1));
                aside->addChild(lit);
                place.scene.addChild(aside);
            });
    compare("a texture overridden from above",
            [](const Place& place)
            {
                place.above.getOrCreateStateSet()->setTextureAttributeAndModes(0, makeTexture(GL_RGB),
                                                                               overriding);
                addTexture(place.state(), 0, GL_ALPHA, osg::TexEnv::REPLACE);
                place.scene.addChild(makeWaves());
            });
    compare("deep below",
            [](const Place& place)
            {
                addSun({place.above, place.above});
                osg::Group* parent = &place.scene;
                for (int i = 0; i < 100; ++i)
                {
                    osg::ref_ptr<osg::Group> child = new osg::Group;
                    child->getOrCreateStateSet()->setMode(GL_CULL_FACE, i % 2 ? on : off);
                    parent->addChild(child);
                    parent = child;
                }
                parent->addChild(makeWaves());
            });
}

TEST_F(FixedFunctionLook, Programs)
{
    const char* const green = "#version 120\nvoid main() { gl_FragColor = vec4(0.0, 0.8, 0.1, 1.0); }\n";
    const auto shaded = [=]
    {
        osg::ref_ptr<osg::Program> program = new osg::Program;
        program->addShader(new osg::Shader(osg::Shader::FRAGMENT, green));
        return program;
    };
    compare(
        "a program of its own",
        [&](const Place& place)
        {
            place.state().setAttribute(shaded());
            place.scene.addChild(makeWaves());
        },
        0, false);
    compare("a program above, none here",
            [&](const Place& place)
            {
                place.above.getOrCreateStateSet()->setAttribute(shaded());
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->getOrCreateStateSet()->setAttribute(new osg::Program);
                place.scene.addChild(waves);
            });
    compare("no program, by force",
            [&](const Place& place)
            {
                place.above.getOrCreateStateSet()->setAttribute(new osg::Program, overriding);
                osg::ref_ptr<osg::Geometry> waves = makeWaves();
                waves->getOrCreateStateSet()->setAttribute(shaded());
                place.scene.addChild(waves);
            });
    compare(
        "text",
        [](const Place& place)
        {
            osg::ref_ptr<osgText::Text> text = new osgText::Text;
            text->setText("Waimea Bay");
            text->setCharacterSize(1.6f);
            text->setAxisAlignment(osgText::Text::XZ_PLANE);
            text->setAlignment(osgText::Text::CENTER_CENTER);
            text->setBackdropType(osgText::Text::OUTLINE);
            text->setColor({1, 0.9f, 0.2f, 1});
            place.scene.addChild(text);
        },
        0, false);
}

TEST_F(FixedFunctionLook, Shapes)
{
    compare(
        "shapes",
        [](const Place& place)
        {
            addSun(place);
            place.state().setAttribute(makeMaterial(30, osg::Material::AMBIENT_AND_DIFFUSE));
            osg::ref_ptr<osg::Geode> geode = new osg::Geode;
            const auto add = [&](osg::Shape* shape, const osg::Vec4& color)
            {
                osg::ref_ptr<osg::ShapeDrawable> drawable = new osg::ShapeDrawable(shape);
                drawable->setColor(color);
                geode->addDrawable(drawable);
            };
            add(new osg::Box({-2, 0, 0}, 1.5f), {1, 0.4f, 0.3f, 1});
            add(new osg::Sphere({0, 0, 0.5f}, 1), {0.3f, 0.9f, 0.3f, 1});
            add(new osg::Cone({2, 0, 0}, 1, 2), {0.4f, 0.4f, 1, 1});
            place.scene.addChild(geode);
        },
        2); // pow() of the shininess
}

TEST_F(FixedFunctionLook, BeforeTheBend)
{
    const Build build = [](const Place& place)
    {
        addSun(place);
        addTexture(place.state(), 0, GL_RGB, osg::TexEnv::MODULATE);
        place.state().setAttribute(makeMaterial(0, osg::Material::AMBIENT_AND_DIFFUSE));
        for (int i = 0; i < 5; ++i)
        {
            osg::ref_ptr<osg::MatrixTransform> turned =
                new osg::MatrixTransform(osg::Matrix::rotate(0.7 * i, osg::Vec3d(0.3, 0.2, 1)) *
                                         osg::Matrix::translate(i - 2, i - 1, 0));
            turned->addChild(makeWaves());
            place.scene.addChild(turned);
        }
    };
    const osg::ref_ptr<osg::Image> expected = renderPlain(build);
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    root->addChild(scene);
    build({*root, *scene});
    const osg::ref_ptr<osgGeoFX::BirdsEyeView> far = new osgGeoFX::BirdsEyeView;
    // The picture's top meets the ground 34 m away.
    far->setHorizonLine(1.0);
    far->setFocusLine(0.99);
    scene->addEffect(far);
    expectSame(*render(root), *expected, 1, "");
    far->setFocusLine(0.1);
    const osg::ref_ptr<osg::Image> bent = render(root);
    EXPECT_NE(std::memcmp(bent->data(), expected->data(), expected->getTotalSizeInBytes()), 0);
}
