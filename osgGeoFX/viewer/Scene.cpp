// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/viewer/Scene.h>

#include <osgGeoFX/paging/PluginFolder.h>
#include <osgGeoFX/paging/RemoteFiles.h>
#include <osgGeoFX/scene/RigidModel.h>
#include <osgGeoFX/viewer/EarthSky.h>
#include <osgGeoFX/viewer/detail/HorizonClamp.h>

#include <osg/BoundingBox>
#include <osg/LOD>
#include <osg/Math>
#include <osg/ValueObject>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <cmath>
#include <exception>

namespace osgGeoFX
{

namespace
{

/// Points along the edge of a terrain, low and high; none for one that goes round the globe.
std::vector<osg::Vec3d> outlineOf(const TerrainInfo& info, const Georeference* reference)
{
    std::vector<osg::Vec3d> points;
    if (info.geocentric && (!reference || info.east - info.west > 90.0))
    {
        return points;
    }
    for (int i = 0; i < 50; ++i)
    {
        const double x = info.west + (i % 5) * (info.east - info.west) / 4.0;
        const double y = info.south + (i / 5 % 5) * (info.north - info.south) / 4.0;
        const double z = i < 25 ? info.minHeight : info.maxHeight;
        osg::Vec3d world(x, y, z);
        if (info.geocentric)
        {
            reference->toWorld(osg::DegreesToRadians(x), osg::DegreesToRadians(y), z, world);
        }
        points.push_back(world);
    }
    return points;
}

} // namespace

std::optional<SceneSettings> SceneSettings::read(const osg::Node& root, std::string& error)
{
    SceneSettings settings;
    std::string text;
    if (root.getUserValue("geofx.homeView", text))
    {
        settings.homeView = ViewPoint::parse(text, error);
        if (!settings.homeView)
        {
            error = "The scene's home view is wrong: " + error;
            return std::nullopt;
        }
    }
    double fieldOfView = 0.0;
    if (root.getUserValue("geofx.homeFov", fieldOfView))
    {
        if (!(fieldOfView > 0.0 && fieldOfView < 180.0))
        {
            error = "The scene's field of view must lie between 0 and 180 degrees.";
            return std::nullopt;
        }
        settings.homeFov = fieldOfView;
    }
    if (root.getUserValue("geofx.background", text))
    {
        const std::optional<std::vector<double>> rgb = parseNumbers(text);
        if (!rgb || rgb->size() != 3)
        {
            error = "The scene's background \"" + text + "\" is not a color; write r,g,b with values 0 to 1.";
            return std::nullopt;
        }
        for (unsigned int i = 0; i < 3; ++i)
        {
            settings.background[i] = static_cast<float>((*rgb)[i]);
        }
    }
    root.getUserValue("geofx.hasLight", settings.hasLight);
    root.getUserValue("geofx.hasSky", settings.hasSky);
    double visibility = 0.0;
    if (root.getUserValue("geofx.visibility", visibility))
    {
        if (!(visibility > 0.0))
        {
            error = "The scene's visibility must be above 0 metres.";
            return std::nullopt;
        }
        settings.visibility = visibility;
    }
    return settings;
}

namespace
{

EffectScene* findEffects(osg::Node* node, int depth)
{
    if (auto* found = dynamic_cast<EffectScene*>(node)) return found;
    osg::Group* group = node->asGroup();
    if (!group || depth == 0 || dynamic_cast<osg::LOD*>(node)) return nullptr;
    for (unsigned int i = 0; i < group->getNumChildren(); ++i)
    {
        if (EffectScene* found = findEffects(group->getChild(i), depth - 1)) return found;
    }
    return nullptr;
}

} // namespace

namespace
{

/// Null, with a sentence in `error`, if the file cannot be read; `what` it is: "scene".
osg::ref_ptr<osg::Node> readNode(const std::string& what, const std::string& file, std::string& error,
                                 const osgDB::Options* options)
{
    addPluginFolder();
    const bool isRemote = RemoteFiles::isRemote(file),
               isScene = osgDB::getLowerCaseFileExtension(file) == "geofx";
    // The plugin of scene files fetches them, and what they name, by itself. OSG would ask others, too, when it fails.
    osgDB::ReaderWriter* const plugin =
        isRemote && isScene ? osgDB::Registry::instance()->getReaderWriterForExtension("geofx") : nullptr;
    if (isRemote && !isScene)
    {
        const RemoteFiles::Node read = RemoteFiles::readNode(file, options, RemoteFiles::Order::ServerFirst);
        if (read.node) return read.node;
        error = "The " + what + " \"" + file + "\" cannot be read (" + read.reason + "); " +
                RemoteFiles::remedyOf(read.fault);
        return nullptr;
    }
    // Names such as "cow.osgt.10.scale" are no files, and yet OSG reads them.
    std::string reason = osgDB::fileExists(file) ? TileGuard::faultOf(file) : std::string();
    osgDB::ReaderWriter::ReadResult result;
    try
    {
        if (reason.empty())
            result = plugin ? plugin->readNode(file, options)
                            : osgDB::Registry::instance()->readNode(file, options);
    }
    catch (const std::exception& exception)
    {
        reason = exception.what();
    }
    if (result.validNode()) return result.getNode();
    if (!isRemote && !osgDB::fileExists(file)) reason = "it does not exist";
    if (reason.empty()) reason = result.statusMessage();
    error = "The " + what + " \"" + file + "\" cannot be read (" + reason +
            "); name a file that OpenSceneGraph or one of its plugins reads.";
    return nullptr;
}

} // namespace

std::optional<Scene> Scene::load(const std::string& file, std::string& error, const osgDB::Options* options)
{
    const osg::ref_ptr<osg::Node> node = readNode("scene", file, error, options);
    if (!node) return std::nullopt;
    return adopt(node, error);
}

std::optional<Scene> Scene::adopt(osg::Node* node, std::string& error)
{
    Scene scene;
    scene.node = node;
    const std::optional<SceneSettings> settings = SceneSettings::read(*node, error);
    if (!settings)
    {
        return std::nullopt;
    }
    scene.settings = *settings;
    error.clear();
    scene.terrain = TerrainInfo::read(node, error);
    if (!error.empty())
    {
        return std::nullopt;
    }
    scene.guard = TileGuard::install(node);
    scene.reference = Georeference::create(node, scene.referenceError);
    scene.effects = findEffects(node, 4);
    if (!scene.effects)
    {
        scene.effects = new EffectScene;
        scene.effects->addChild(node);
        scene.node = scene.effects;
    }
    scene.effects->listenTo(*scene.guard);
    return scene;
}

bool Scene::addCity(const std::string& file, std::string& error, const osgDB::Options* options)
{
    const osg::ref_ptr<osg::Node> city = readNode("city model", file, error, options);
    if (!city) return false;
    const osg::ref_ptr<RigidModel> rigid = new RigidModel(effects->ground().ellipsoid);
    rigid->prepare(*city);
    const osg::ref_ptr<TileGuard> tiles = TileGuard::install(city);
    tiles->addListener(rigid);
    effects->listenTo(*tiles);
    effects->addChild(city);
    return true;
}

bool Scene::addSky(std::string& error)
{
    if (!reference || !reference->isGeocentric())
    {
        error =
            "The scene has no round Earth to put a sky around; leave out the sky, or build its terrain with "
            "--geocentric.";
        return false;
    }
    if (settings.hasSky) return true;
    osg::ref_ptr<osg::Group> both = new osg::Group;
    const osg::Vec3 air(settings.background.r(), settings.background.g(), settings.background.b());
    both->addChild(
        makeEarthSky(osg::EllipsoidModel(), air, settings.visibility.value_or(DEFAULT_VISIBILITY), effects));
    both->addChild(node);
    node = both;
    settings.hasSky = true;
    return true;
}

osg::ref_ptr<DepthReader> Scene::readDepths()
{
    osg::ref_ptr<DepthReader> reader = new DepthReader;
    reader->setImmediate(true);
    reader->setDepthConvention(effects->getDepthConvention());
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(node);
    both->addChild(reader);
    node = both;
    return reader;
}

void Scene::setUpView(osg::View& view) const
{
    view.getCamera()->setClearColor(settings.background);
    // OSG's default keeps near and far within 1 : 2000, which cuts off the foreground of a wide landscape.
    view.getCamera()->setNearFarRatio(0.0002);
    if (terrain && reference && reference->isGeocentric())
    {
        // A walker sees the ground before the feet, and mountains that stand above the horizon.
        view.getCamera()->setNearFarRatio(0.00002);
        view.getCamera()->setClampProjectionMatrixCallback(
            new HorizonClamp(*view.getCamera(), *effects, terrain->maxHeight));
    }
    view.setLightingMode(settings.hasLight ? osg::View::NO_LIGHT : osg::View::HEADLIGHT);
}

float Scene::lodScale(double height, double fieldOfView) const
{
    return terrain ? lodScaleFor(*terrain, pixelsPerRadian(height, fieldOfView)) : 1.0f;
}

osg::Matrixd Scene::homeViewMatrix(double fieldOfView, double aspect) const
{
    osg::Matrixd view;
    if (settings.homeView && reference && settings.homeView->viewMatrix(*reference, view))
    {
        return view;
    }
    const osg::BoundingSphere& bound = node->getBound();
    std::vector<osg::Vec3d> points =
        terrain ? outlineOf(*terrain, reference.get()) : std::vector<osg::Vec3d>();
    osg::BoundingBoxd box;
    for (const osg::Vec3d& point : points)
        box.expandBy(point);
    if (points.empty())
    {
        const auto radius = static_cast<double>(bound.radius());
        for (int corner = 0; corner < 8; ++corner)
        {
            points.push_back(osg::Vec3d(bound.center()) + osg::Vec3d(corner & 1 ? radius : -radius,
                                                                     corner & 2 ? radius : -radius,
                                                                     corner & 4 ? radius : -radius) /
                                                              std::sqrt(3.0));
        }
    }
    const osg::Vec3d center = box.valid() ? box.center() : osg::Vec3d(bound.center());
    return viewOfPoints(points, center, reference.get(), fieldOfView, aspect);
}

} // namespace osgGeoFX
