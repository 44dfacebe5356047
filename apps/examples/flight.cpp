// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
//
// A terrain on a disk or a web server whose tiles are there before the camera is, in 256 MiB: flight FILE-OR-ADDRESS
#include <osgGA/TerrainManipulator>
#include <osgGeoFX/paging/MemoryBudget.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/scene/TilePrefetch.h>
#include <osgGeoFX/viewer/Scene.h>
#include <osgViewer/Viewer>

int main(int argc, char** argv)
{
    std::string error;
    const std::optional<osgGeoFX::Scene> scene = osgGeoFX::Scene::load(argc > 1 ? argv[1] : "", error);
    if (!scene) return 1;

    osgViewer::Viewer viewer;
    osgDB::DatabasePager& pager = *viewer.getDatabasePager();
    osgGeoFX::RemoteFiles::setUpThreads(pager, 1);
    const osg::ref_ptr<osgGeoFX::MemoryBudget> budget = new osgGeoFX::MemoryBudget(pager);
    budget->setLimits(256.0, 0.0); // MiB of main memory; what was seen longest ago goes first
    budget->watch(*scene->node, *scene->guard);
    const osg::ref_ptr<osgGeoFX::TilePrefetch> prefetch = new osgGeoFX::TilePrefetch;
    prefetch->setLead(5.0); // asks for what the camera will see in five seconds, if it goes on like that
    prefetch->setBudget(budget);
    scene->effects->setPrefetch(prefetch);

    viewer.setSceneData(scene->node);
    viewer.setCameraManipulator(new osgGA::TerrainManipulator);
    return viewer.run();
}
