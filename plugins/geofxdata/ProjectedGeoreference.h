// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/paging/Georeference.h>

#include <ogr_spatialref.h>

#include <memory>
#include <mutex>

namespace osgGeoFX
{

/** Georeference of a database in a projected coordinate system: the world is easting, northing and height, in
    metres whatever the system's own unit is. Heights are handed through. */
class ProjectedGeoreference : public Georeference
{
public:
    /// Null, with a sentence in `error`, if the text is no projected coordinate system on a known datum.
    static osg::ref_ptr<ProjectedGeoreference> create(const std::string& wkt, std::string& error);

    osg::Object* cloneType() const override { return clone(osg::CopyOp::SHALLOW_COPY); }
    osg::Object* clone(const osg::CopyOp& op) const override;
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "ProjectedGeoreference"; }

    bool isGeocentric() const override { return false; }
    bool toWorld(double longitude, double latitude, double height, osg::Vec3d& world) const override;
    bool toGeodetic(const osg::Vec3d& world, double& longitude, double& latitude,
                    double& height) const override;
    bool localToWorld(double longitude, double latitude, double height, osg::Matrixd& frame) const override;

private:
    struct Destroyer
    {
        void operator()(OGRCoordinateTransformation* t) const { OGRCoordinateTransformation::DestroyCT(t); }
    };
    using Transformation = std::unique_ptr<OGRCoordinateTransformation, Destroyer>;

    ProjectedGeoreference(Transformation toGrid, Transformation fromGrid, double metresPerUnit);
    ProjectedGeoreference(const ProjectedGeoreference& other, const osg::CopyOp& op);
    ~ProjectedGeoreference() override = default;

    bool transform(OGRCoordinateTransformation& transformation, double& x, double& y) const;

    mutable std::mutex _mutex; ///< a transformation must not be used by two threads at once
    Transformation _toGrid, _fromGrid;
    double _metresPerUnit;
};

} // namespace osgGeoFX
