// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/GroundShade.h>
#include <osgGeoFX/effect/RigidParts.h>

#include <gdal_priv.h>
#include <ogrsf_frmts.h>
#include <osg/MatrixTransform>
#include <osg/PagedLOD>
#include <osgDB/ReadFile>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace geofx::test
{

/// A feature to be written: the polygon as WKT, and the text of each field.
struct Feature
{
    std::string wkt;
    std::vector<std::string> values;
};

/// Writes polygons as a GeoPackage, each made when it is its turn, so that millions take no memory. Fields: names, with ":real"
/// behind those of numbers. Values that are empty are left out.
inline std::string writeFeatures(const std::filesystem::path& file, const std::vector<std::string>& fields,
                                 std::size_t count, const std::function<Feature(std::size_t)>& make,
                                 const std::string& crs = "EPSG:4326", const std::string& format = "GPKG")
{
    GDALAllRegister();
    std::filesystem::remove(file);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(format.c_str());
    const std::unique_ptr<GDALDataset> data(driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    OGRSpatialReference srs;
    srs.SetFromUserInput(crs.c_str());
    srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRLayer* layer = data->CreateLayer("some", crs.empty() ? nullptr : &srs, wkbUnknown, nullptr);
    for (const std::string& field : fields)
    {
        const std::size_t colon = field.find(":real");
        OGRFieldDefn definition(field.substr(0, colon).c_str(),
                                colon == std::string::npos ? OFTString : OFTReal);
        layer->CreateField(&definition);
    }
    data->StartTransaction();
    for (std::size_t number = 0; number < count; ++number)
    {
        const Feature each = make(number);
        OGRGeometry* geometry = nullptr;
        OGRGeometryFactory::createFromWkt(each.wkt.c_str(), nullptr, &geometry);
        // A number that is none has no words.
        if (each.wkt == "NAN")
        {
            OGRLinearRing ring;
            ring.addPoint(10.05, 46.95);
            ring.addPoint(std::nan(""), 46.9502);
            ring.addPoint(10.0502, 46.9502);
            ring.closeRings();
            auto* polygon = new OGRPolygon;
            polygon->addRing(&ring);
            geometry = polygon;
        }
        if (!geometry) throw std::runtime_error("No geometry: " + each.wkt);
        const std::unique_ptr<OGRFeature> feature(OGRFeature::CreateFeature(layer->GetLayerDefn()));
        feature->SetGeometryDirectly(geometry);
        for (std::size_t i = 0; i < each.values.size(); ++i)
            if (!each.values[i].empty())
            {
                // As a number where it is one that text would not reach the file as.
                if (each.values[i] == "nan" && fields[i].find(":real") != std::string::npos)
                    feature->SetField(static_cast<int>(i), std::nan(""));
                else
                    feature->SetField(static_cast<int>(i), each.values[i].c_str());
            }
        if (layer->CreateFeature(feature.get()) != OGRERR_NONE)
            throw std::runtime_error("The feature cannot be written.");
    }
    data->CommitTransaction();
    return file.string();
}

inline std::string writeFeatures(const std::filesystem::path& file, const std::vector<std::string>& fields,
                                 const std::vector<Feature>& features, const std::string& crs = "EPSG:4326",
                                 const std::string& format = "GPKG")
{
    return writeFeatures(
        file, fields, features.size(), [&](std::size_t i) { return features[i]; }, crs, format);
}

/// A rectangle about a place, `width` and `depth` in the CRS's units.
inline std::string rectangle(double x, double y, double width, double depth)
{
    return CPLSPrintf("POLYGON((%.9f %.9f,%.9f %.9f,%.9f %.9f,%.9f %.9f,%.9f %.9f))", x - width / 2,
                      y - depth / 2, x + width / 2, y - depth / 2, x + width / 2, y + depth / 2,
                      x - width / 2, y + depth / 2, x - width / 2, y - depth / 2);
}

/// A building of a town's file.
struct TownBuilding
{
    osg::Vec3d reference; ///< in the world
    std::vector<osg::Vec3d> vertices;
    osg::Vec3d up;
    double lowest = 1e300, highest = -1e300; ///< of the vertices, above the reference, metres
};

/// Hands out the geometries of a town's file, each with its matrix to the world: its buildings, or the shade around them. It loads no
/// other files.
inline void forEachGeometry(const std::filesystem::path& file,
                            const std::function<void(const osg::Geometry&, const osg::Matrixd&)>& take,
                            bool shades = false)
{
    struct Visitor : osg::NodeVisitor
    {
        Visitor(const std::function<void(const osg::Geometry&, const osg::Matrixd&)>& function, bool wanted)
            : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN), take(function), shades(wanted)
        {
        }
        void apply(osg::Geometry& geometry) override
        {
            if (osgGeoFX::GroundShade::is(geometry) == shades)
                take(geometry, osg::computeLocalToWorld(getNodePath()));
        }
        const std::function<void(const osg::Geometry&, const osg::Matrixd&)>& take;
        const bool shades;
    } visitor(take, shades);
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(file.string());
    if (!node) throw std::runtime_error(file.string() + " cannot be read.");
    node->accept(visitor);
}

/// All buildings, or blocks, of a level of a town: "detail", "single" or "blocks".
inline std::vector<TownBuilding> buildingsOf(const std::filesystem::path& database, const std::string& level)
{
    std::vector<TownBuilding> result;
    const std::filesystem::path folder = database / "buildings" / level;
    if (!std::filesystem::exists(folder)) return result;
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.insert(entry.path());
    for (const auto& file : files)
        forEachGeometry(
            file,
            [&](const osg::Geometry& geometry, const osg::Matrixd& toWorld)
            {
                const osg::Vec4Array* references = osgGeoFX::RigidParts::of(geometry);
                if (!references) throw std::runtime_error("A geometry has no references.");
                const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
                osg::Vec4 last;
                for (std::size_t i = 0; i < vertices.size(); ++i)
                {
                    const osg::Vec4& here = (*references)[i];
                    if (i == 0 || here != last)
                    {
                        result.emplace_back();
                        result.back().reference = osg::Vec3d(here.x(), here.y(), here.z()) * toWorld;
                        result.back().up = osg::Matrixd::transform3x3(osg::Vec3d(0, 0, 1), toWorld);
                    }
                    last = here;
                    TownBuilding& building = result.back();
                    building.vertices.push_back(osg::Vec3d(vertices[i]) * toWorld);
                    const double height = static_cast<double>(vertices[i].z() - here.z());
                    building.lowest = std::min(building.lowest, height);
                    building.highest = std::max(building.highest, height);
                }
            });
    return result;
}

} // namespace geofx::test
