// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/effect/DeformationChain.h>
#include <osgGeoFX/paging/Georeference.h>
#include <osgGeoFX/panorama/PanoramaMap.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Matrixd>
#include <osg/Vec2d>

#include <memory>
#include <optional>
#include <vector>

namespace osgGeoFX
{

class LiftedPlaces;

/** Where the pixels of a finished picture lie on the ground.

    It goes from the depths that were drawn back through the deformation. So it knows what DeformedView::pick() knows, for all
    pixels at once: a pick visits the triangles and takes milliseconds. A place, projected again, lies in the middle of its pixel. Along the
    line of sight it is as exact as the depth buffer: within a few metres in most pictures, and within the height of half a pixel with
    multisampling, which keeps the depth of one sample.

    A pixel of a close-up has the place of the ground that the close-up shows. What else stands above the ground counts as drawn, as long as it writes depths: strokes of panorama maps do, and have the place where
    they stand and the height of their point. A pick looks through them; WithoutStrokes draws such depths.

    An object keeps the camera, the effects and the depths as they were when it was made. Make it where the scene graph may be read. Threads:
    any thread may ask it.
    @ingroup print */
class OSGGEOFXMAPS_EXPORT PlacePicture
{
public:
    struct Place
    {
        double longitude = 0.0; ///< degrees, −180…180
        double latitude = 0.0;  ///< degrees
        double height = 0.0;    ///< metres above the database's zero height
        double distance = 0.0;  ///< metres from the eye, in the deformed picture as drawn
    };

    /** `camera`: of the whole picture, with its viewport. `depths`: of the frame, from the cameras that drew the picture or its parts
        (DepthReader::pictures()); pixels that none of them has have no place, nor have those without depths. */
    PlacePicture(EffectScene& scene, const osg::Camera& camera,
                 const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                 const Georeference& reference);
    /// The same for a scene without a georeference: there are distances, and no places.
    PlacePicture(EffectScene& scene, const osg::Camera& camera,
                 const std::vector<std::shared_ptr<const DepthPicture>>& depths);

    int width() const { return _width; } ///< pixels
    int height() const { return _height; }
    /** The place at the middle of a pixel; x from the left, y from the uppermost row, both from 0. Empty for sky, for what a deformation has
        gathered in one point, outside of the picture and beyond the projection. */
    std::optional<Place> at(int x, int y) const;
    /// The distance alone, metres, which needs no ground; empty for sky.
    std::optional<double> distanceAt(int x, int y) const;

private:
    /// A part of the picture that one camera drew.
    struct Part
    {
        std::shared_ptr<const DepthPicture> picture;
        osg::ref_ptr<const DeformationChain> chain;
        CameraDepth depth;
        osg::Matrixd inverse; ///< of its projection
        osg::Vec2d low, high; ///< its corners in the picture, pixels, y upwards
    };
    /// What is drawn at a pixel.
    struct Seen
    {
        const Part* part = nullptr;
        osg::Vec2d place; ///< in the part, x and y from −1 to 1
        osg::Vec3d eye;   ///< as drawn, eye space
    };
    std::optional<Seen> seenAt(int x, int y) const;
    /// The place of the ground without close-ups, world coordinates.
    std::optional<osg::Vec3d> groundAt(const Seen& seen) const;

    int _width;
    int _height;
    osg::Matrixd _toWorld; ///< from eye space to the frame of the scene's children
    osg::ref_ptr<const Georeference> _reference;
    std::vector<Part> _parts;
    std::shared_ptr<const LiftedPlaces> _lifted;
};

/** Switches the strokes of a scene's panorama maps off for its lifetime, so that a frame's depths are those of the ground. Make it between
    frames.
    @ingroup print */
class OSGGEOFXMAPS_EXPORT WithoutStrokes
{
public:
    explicit WithoutStrokes(EffectScene& scene);
    ~WithoutStrokes();
    WithoutStrokes(const WithoutStrokes&) = delete;
    WithoutStrokes& operator=(const WithoutStrokes&) = delete;
    /// Whether there are any.
    bool changes() const { return !_maps.empty(); }

private:
    std::vector<osg::ref_ptr<PanoramaMap>> _maps;
};

} // namespace osgGeoFX
