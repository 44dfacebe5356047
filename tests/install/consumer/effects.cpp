// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// Effects that are not the kit's own, through what is installed and nothing else: does each draw what it says?
#include <Contours.h>
#include <Lean.h>
#include <Outline.h>

#include <osg/Geometry>
#include <osg/ShapeDrawable>
#include <osgGeoFX/osgGeoFX.h>
#include <osgViewer/Viewer>

#include <cstdlib>
#include <functional>
#include <iostream>

namespace
{

constexpr int size = 200;

/// A block 200 m high on a square of ground, seen from the south and above.
osg::ref_ptr<osg::Image> draw(osgGeoFX::EffectScene& scene)
{
    osg::ref_ptr<osg::GraphicsContext::Traits> traits = new osg::GraphicsContext::Traits;
    traits->width = traits->height = size;
    osgViewer::Viewer viewer;
    viewer.setThreadingModel(osgViewer::Viewer::SingleThreaded);
    osg::Camera& camera = *viewer.getCamera();
    camera.setGraphicsContext(new osgGeoFX::EglGraphicsContext(traits));
    camera.setViewport(0, 0, size, size);
    camera.setClearColor(osg::Vec4(0, 0, 1, 1));
    camera.setProjectionMatrixAsPerspective(40.0, 1.0, 1.0, 1e4);
    camera.setViewMatrixAsLookAt(osg::Vec3d(0, -1200, 600), osg::Vec3d(0, 0, 100), osg::Z_AXIS);
    const osg::ref_ptr<osgGeoFX::ImageCapture> capture = osgGeoFX::ImageCapture::attach(&camera);
    viewer.setSceneData(&scene);
    viewer.setCameraManipulator(nullptr);
    viewer.realize();
    viewer.frame();
    capture->request();
    viewer.frame();
    return capture->take();
}

using Test = std::function<bool(int r, int g, int b)>;
int count(const osg::Image& image, const Test& test, int from = 0, int to = size)
{
    int found = 0;
    for (int y = 0; y < size; ++y)
    {
        for (int x = from; x < to; ++x)
        {
            const unsigned char* pixel =
                image.data(static_cast<unsigned int>(x), static_cast<unsigned int>(y));
            if (test(pixel[0], pixel[1], pixel[2])) ++found;
        }
    }
    return found;
}

void demand(bool what, const char* sentence)
{
    if (what) return;
    std::cerr << sentence << std::endl;
    std::exit(1);
}

} // namespace

int main()
{
    const osg::ref_ptr<osg::Geometry> ground =
        osg::createTexturedQuadGeometry(osg::Vec3(-300, -300, 0), osg::X_AXIS * 600, osg::Y_AXIS * 600);
    ground->setStateSet(nullptr);
    const osg::ref_ptr<osg::ShapeDrawable> block =
        new osg::ShapeDrawable(new osg::Box(osg::Vec3(0, 0, 100), 100, 100, 200));
    const osg::ref_ptr<osgGeoFX::EffectScene> scene = new osgGeoFX::EffectScene;
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    scene->addChild(ground);
    scene->addChild(block);
    const Test orange = [](int r, int g, int b)
    {
        return r > 200 && g > 90 && g < 190 && b < 60;
    };
    const Test brown = [](int r, int g, int b)
    {
        return r > 60 && r < 160 && g < 90 && b < 60;
    };
    const Test sky = [](int r, int, int b)
    {
        return r == 0 && b == 255;
    };
    const osg::ref_ptr<osg::Image> plain = draw(*scene);
    demand(plain && count(*plain, sky) > 1000 && count(*plain, sky) < size * size - 5000,
           "There is no picture of a block on the ground.");
    demand(count(*plain, orange) + count(*plain, brown) == 0, "Something is orange or brown already.");

    const osg::ref_ptr<Outline> outline = new Outline;
    scene->addEffect(outline);
    demand(count(*draw(*scene), orange) == 0, "Nothing is selected, and there is an outline.");
    outline->select(block);
    const osg::ref_ptr<osg::Image> outlined = draw(*scene);
    // Around the block, some 230 pixels, three wide on the outside; and nowhere else.
    const int all = count(*outlined, orange), around = count(*outlined, orange, 75, 125);
    demand(around > 150 && around < 1500, "The block has no outline.");
    demand(all == around, "There is an outline where nothing is selected.");
    demand(count(
               *outlined, [](int r, int g, int b) { return r > 240 && g > 240 && b > 240; }, 95, 105) > 200,
           "The outline covers the block.");

    outline->setEnabled(false);
    const osg::ref_ptr<Contours> contours = new Contours;
    scene->addEffect(contours);
    demand(count(*draw(*scene), brown) > 20, "The block has no contour lines.");

    contours->setEnabled(false);
    scene->addEffect(new Lean);
    const osg::ref_ptr<osg::Image> leaning = draw(*scene);
    demand(count(*leaning, sky, 0, 105) > count(*plain, sky, 0, 105) + 100 &&
               count(*leaning, sky, 105) < count(*plain, sky, 105) - 100,
           "The block does not lean to the right.");
    return 0;
}
