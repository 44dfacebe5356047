// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#include <osgGeoFX/paging/Georeference.h>

#include <osgGeoFX/paging/PluginFolder.h>

#include <osg/NodeVisitor>
#include <osgDB/Options>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <cmath>

namespace osgGeoFX
{

namespace
{

class FindCoordinateSystem : public osg::NodeVisitor
{
public:
    FindCoordinateSystem() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }

    void apply(osg::Node& node) override
    {
        if (!found) traverse(node);
    }
    void apply(osg::CoordinateSystemNode& node) override
    {
        if (!found) found = &node;
    }

    const osg::CoordinateSystemNode* found = nullptr;
};

class GeocentricReference : public Georeference
{
public:
    explicit GeocentricReference(const osg::EllipsoidModel& ellipsoid)
        : _ellipsoid(new osg::EllipsoidModel(ellipsoid))
    {
        // OSG's WGS 84 has its polar radius rounded to 0.1 mm.
        constexpr double exactPolarRadius = 6356752.314245179;
        if (std::abs(ellipsoid.getRadiusPolar() - exactPolarRadius) < 1e-3)
        {
            _ellipsoid->setRadiusPolar(exactPolarRadius);
        }
    }
    GeocentricReference() : _ellipsoid(new osg::EllipsoidModel) {}
    GeocentricReference(const GeocentricReference& other, const osg::CopyOp& op)
        : Georeference(other, op), _ellipsoid(other._ellipsoid)
    {
    }
    META_Object(osgGeoFX, GeocentricReference)

        bool isGeocentric() const override
    {
        return true;
    }

    bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const override
    {
        _ellipsoid->convertLatLongHeightToXYZ(latitude, longitude, height, world.x(), world.y(), world.z());
        return true;
    }

    // OSG's own inverse takes one step of this iteration and divides by cos(latitude) at the poles.
    bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                    double& height) const override
    {
        const double a = _ellipsoid->getRadiusEquator();
        const double b = _ellipsoid->getRadiusPolar();
        const double eccentricity2 = 1.0 - (b * b) / (a * a);
        const double secondEccentricity2 = (a * a) / (b * b) - 1.0;
        const double p = std::hypot(world.x(), world.y());
        longitude = std::atan2(world.y(), world.x());
        double reduced = std::atan2(world.z() * a, p * b);
        for (int i = 0; i < 4; ++i)
        {
            const double s = std::sin(reduced);
            const double c = std::cos(reduced);
            latitude = std::atan2(world.z() + secondEccentricity2 * b * s * s * s,
                                  p - eccentricity2 * a * c * c * c);
            reduced = std::atan2(b * std::sin(latitude), a * std::cos(latitude));
        }
        const double sine = std::sin(latitude);
        height = p * std::cos(latitude) + world.z() * sine - a * std::sqrt(1.0 - eccentricity2 * sine * sine);
        return true;
    }

    bool localToWorld(double longitude, double latitude, double height, osg::Matrixd& frame) const override
    {
        _ellipsoid->computeLocalToWorldTransformFromLatLongHeight(latitude, longitude, height, frame);
        return true;
    }

protected:
    ~GeocentricReference() override = default;

private:
    osg::ref_ptr<osg::EllipsoidModel> _ellipsoid;
};

osg::ref_ptr<Georeference> createProjected(const std::string& wkt, std::string& error)
{
    addPluginFolder();
    osgDB::ReaderWriter* plugin = osgDB::Registry::instance()->getReaderWriterForExtension("geofxdata");
    if (!plugin)
    {
        error =
            "The scene has a projected coordinate system, and the OSG plugin osgdb_geofxdata, which knows "
            "projections, was not found; put its folder on OSG_LIBRARY_PATH.";
        return nullptr;
    }
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->setPluginStringData("wkt", wkt);
    osgDB::ReaderWriter::ReadResult result = plugin->readObject("georeference", options.get());
    osg::ref_ptr<Georeference> reference = dynamic_cast<Georeference*>(result.getObject());
    if (!reference)
    {
        error =
            "The scene's coordinate system cannot be used: " +
            (result.message().empty() ? std::string("its WKT text is not understood.") : result.message());
    }
    return reference;
}

} // namespace

osg::ref_ptr<Georeference> Georeference::create(const osg::Node* node, std::string& error)
{
    FindCoordinateSystem finder;
    if (node) const_cast<osg::Node*>(node)->accept(finder);
    if (!finder.found)
    {
        error =
            "The scene has no coordinate system (no osg::CoordinateSystemNode), so it has no longitudes and "
            "latitudes.";
        return nullptr;
    }
    if (const osg::EllipsoidModel* ellipsoid = finder.found->getEllipsoidModel())
    {
        return new GeocentricReference(*ellipsoid);
    }
    return createProjected(finder.found->getCoordinateSystem(), error);
}

} // namespace osgGeoFX
