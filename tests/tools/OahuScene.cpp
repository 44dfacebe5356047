// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <tools/OahuScene.h>

#include <gtest/gtest.h>
#include <osgGeoFX/deformation/BirdsEyeView.h>
#include <osgGeoFX/deformation/BlendedView.h>
#include <osgGeoFX/deformation/PedestrianView.h>
#include <osgGeoFX/deformation/RegionalLiberty.h>
#include <osgGeoFX/deformation/VerticalExaggeration.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <tools/RandomViews.h>

#include <cmath>

using namespace osgGeoFX;

namespace geofx::test
{

namespace
{

void randomizeBend(PerspectiveBend& bend, Random& random)
{
    bend.setCurve(static_cast<PerspectiveBend::Curve>(random.integer(0, 2)));
    bend.setPlaneHeight(random.integer(0, 2) == 0 ? random.uniform(-100.0, 800.0) : 0.0);
    bend.setTransitionDetail(random.uniform(1.0, 4.0));
    bend.setContextDetail(random.uniform(0.5, 1.5));
    bend.setTessellation(bend.getTransitionDetail() < 2.5);
}

osg::ref_ptr<BirdsEyeView> randomBirdsEye(Random& random)
{
    osg::ref_ptr<BirdsEyeView> view = new BirdsEyeView;
    randomizeBend(*view, random);
    view->setHorizonLine(random.uniform(0.5, 0.98));
    view->setFocusLine(random.uniform(0.0, 0.95) * view->getHorizonLine());
    view->setContextTilt(random.integer(0, 1) ? random.uniform(0.0, 0.9) : 0.0);
    return view;
}

osg::ref_ptr<PedestrianView> randomPedestrian(Random& random)
{
    osg::ref_ptr<PedestrianView> view = new PedestrianView;
    randomizeBend(*view, random);
    view->setBendAngle(random.uniform(0.0, osg::PI_2));
    view->setFocusDistance(random.logarithmic(100.0, 8000.0));
    view->setZoneWidth(random.logarithmic(100.0, 8000.0));
    return view;
}

void removeEffects(EffectScene& scene)
{
    while (scene.getNumEffects())
        scene.removeEffect(scene.getEffect(0));
}

} // namespace

std::optional<Scene> loadOahu(const std::string& name)
{
    std::string error;
    const std::string file = GEOFX_BUILD_DIR "/test-data/" + name + "/terrain.osgb";
    std::optional<Scene> scene = Scene::load(file, error);
    EXPECT_TRUE(scene) << error << " The fixture oahu_database builds it.";
    EXPECT_TRUE(!scene || scene->reference) << scene->referenceError;
    return scene && scene->reference ? scene : std::nullopt;
}

osg::Matrixd randomProjection(Random& random)
{
    const double aspect = random.uniform(0.5, 2.0);
    const int kind = random.integer(0, 9);
    if (kind == 0)
    {
        const double half = random.logarithmic(500.0, 30000.0);
        return osg::Matrixd::ortho(-half * aspect, half * aspect, -half, half, 1.0, 2e5);
    }
    const double near = 5.0;
    const double half = near * std::tan(osg::DegreesToRadians(random.uniform(10.0, 100.0)) / 2.0);
    const double shiftX = kind == 1 ? random.uniform(-1.0, 1.0) * half : 0.0;
    const double shiftY = kind == 1 ? random.uniform(-1.0, 1.0) * half : 0.0;
    return osg::Matrixd::frustum(shiftX - half * aspect, shiftX + half * aspect, shiftY - half, shiftY + half,
                                 near, 3e5);
}

/// A camera over Oahu.
osg::Matrixd randomOahuView(Random& random, const Georeference& reference)
{
    ViewPoint point;
    point.longitude = osg::DegreesToRadians(random.uniform(-158.3, -157.6));
    point.latitude = osg::DegreesToRadians(random.uniform(21.2, 21.75));
    point.height = random.logarithmic(100.0, 30000.0);
    point.heading = random.uniform(0.0, 2.0 * osg::PI);
    point.pitch = osg::DegreesToRadians(random.integer(0, 9) == 0 ? -90.0 : random.uniform(-80.0, 5.0));
    point.roll = random.integer(0, 4) == 0 ? random.uniform(-1.0, 1.0) : 0.0;
    osg::Matrixd view;
    EXPECT_TRUE(point.viewMatrix(reference, view));
    return view;
}

void addRandomPainting(EffectScene& scene, Random& random)
{
    removeEffects(scene);
    osg::ref_ptr<PanoramaMap> map = new PanoramaMap;
    map->setHorizonDistance(random.uniform(0.8, 10.0));
    map->setCurveDistance(random.uniform(0.0, 0.9) * map->getHorizonDistance());
    map->setHorizonLine(random.uniform(0.4, 1.0));
    map->setHorizonBend(random.integer(0, 3) ? random.uniform(0.0, 0.1) : 0.0);
    map->setExaggeration(random.logarithmic(0.3, 6.0));
    map->setDetail(random.uniform(0.3, 1.5));
    if (random.integer(0, 2) == 0) map->setViewRadius(random.logarithmic(1000.0, 4e4));
    if (random.integer(0, 1) == 0) map->setHorizonExaggeration(random.logarithmic(0.3, 6.0));
    if (random.integer(0, 1) == 0) map->setCurvePoints(randomCurve(random));
    scene.addEffect(map);
}

void addRandomPanorama(EffectScene& scene, Random& random)
{
    addRandomPainting(scene, random);
    std::string refusal;
    for (const char* part : {"paint", "strokes", "water", "sky"})
        scene.getEffect(0)->setProperty(part, 0.0, refusal);
}

void addRandomEffects(EffectScene& scene, Random& random)
{
    removeEffects(scene);
    const int kind = random.integer(0, 5);
    if (kind == 4 || kind == 5)
    {
        osg::ref_ptr<VerticalExaggeration> exaggeration = new VerticalExaggeration;
        exaggeration->setFactor(random.logarithmic(0.2, 6.0));
        scene.addEffect(exaggeration);
    }
    if (kind == 0 || kind == 5) scene.addEffect(randomBirdsEye(random));
    if (kind == 1) scene.addEffect(randomBirdsEye(random));
    if (kind == 2) scene.addEffect(randomPedestrian(random));
    if (kind == 3)
    {
        osg::ref_ptr<BlendedView> blend = new BlendedView;
        blend->setHighHeight(random.uniform(1000.0, 20000.0));
        blend->setBirdsEyeView(randomBirdsEye(random));
        blend->setPedestrianView(randomPedestrian(random));
        scene.addEffect(blend);
    }
}

void addRandomLiberties(EffectScene& scene, Random& random)
{
    const int kind = random.integer(0, 4);
    if (kind < 2)
        addRandomPanorama(scene, random);
    else if (kind < 4)
        addRandomEffects(scene, random);
    else
        removeEffects(scene);
    for (int more = random.integer(1, 4); more > 0; --more)
    {
        const osg::ref_ptr<RegionalLiberty> liberty = new RegionalLiberty;
        const double longitude = random.uniform(-158.28, -157.66), latitude = random.uniform(21.26, 21.7);
        liberty->setGeodeticCenter(osg::DegreesToRadians(longitude), osg::DegreesToRadians(latitude));
        // Zone 4 of UTM, to some kilometres.
        liberty->setCenter({500000.0 + 103600.0 * (longitude + 159.0), 110680.0 * latitude});
        liberty->setRadii(random.logarithmic(500.0, 15000.0), random.logarithmic(500.0, 15000.0));
        liberty->setHeading(random.uniform(-3.0, 3.0));
        liberty->setBaseHeight(random.integer(0, 1) ? 0.0 : random.uniform(0.0, 800.0));
        if (random.integer(0, 2)) liberty->setEnlarge(random.logarithmic(0.2, 5.0));
        if (random.integer(0, 1)) liberty->setWiden(random.uniform(0.25, 2.0));
        if (random.integer(0, 1)) liberty->setTurn(random.uniform(-osg::PI_2, osg::PI_2));
        scene.insertEffect(0, liberty);
    }
}

} // namespace geofx::test
