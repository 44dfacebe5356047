// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/panorama/PanoramaMap.h>

#include <osg/Vec2d>

#include <cstddef>
#include <optional>
#include <vector>

namespace osgGeoFX
{

/// What CurvePanel shows of a map.
struct CurveState
{
    std::vector<osg::Vec2d> points; ///< as PanoramaMap::getCurvePoints()
    double horizonLine = 0.8;
    double exaggeration = 2.0;
    double horizonExaggeration = -1.0;
    std::vector<double>
        heights; ///< of the curve at even distances from the base to the horizon, of the horizon line

    static CurveState of(const PanoramaMap& map);
    bool operator==(const CurveState& other) const;
    /// Of the curve at a distance, 0…1.
    double heightAt(double distance) const;
};

/** Where things are in a CurvePanel, and what a pointer does with them. All places are pixels of the viewport, with y up.
    It needs no OpenGL. */
class CurveGraph
{
public:
    /// `width` and `height` are the viewport's.
    CurveGraph(double width, double height);

    struct Box
    {
        double left, bottom, width, height;
        bool has(const osg::Vec2d& place) const
        {
            return place.x() >= left && place.y() >= bottom && place.x() < left + width &&
                   place.y() < bottom + height;
        }
    };
    double text, line, margin; ///< sizes
    Box panel, graph, reset;
    Box nearScale, farScale; ///< the tracks of the two exaggerations

    /// The place of a distance (share of D2) and a height (share of the picture's).
    osg::Vec2d placeOf(double distance, double height) const;
    /// The place of an exaggeration's handle.
    osg::Vec2d placeOf(const Box& scale, double exaggeration) const;
    /// The base of the line of text that has a number, from above.
    double lineBottom(int number) const;

    struct Handle
    {
        enum Kind
        {
            POINT,
            CURVE, ///< on the curve, between its points
            NEAR_SCALE,
            FAR_SCALE,
            RESET
        };
        Kind kind = CURVE;
        std::size_t point = 0; ///< index, for POINT

        bool operator==(const Handle& other) const
        {
            return kind == other.kind && (kind != POINT || point == other.point);
        }
    };
    /// What lies at a place; nothing where the panel has nothing to take hold of.
    std::optional<Handle> handleAt(const osg::Vec2d& place, const CurveState& state) const;
    /// The points with a new one on the curve at a place, and its index; nothing where there is no room for one more.
    std::optional<std::size_t> insert(const osg::Vec2d& place, CurveState& state) const;
    /// Moves what is held to a place, as far as its neighbours let it.
    void drag(const Handle& handle, const osg::Vec2d& place, CurveState& state) const;
    /// Removes a point, or the horizon's own exaggeration. False if there is nothing to remove.
    static bool remove(const Handle& handle, CurveState& state);

private:
    double exaggerationAt(const Box& scale, const osg::Vec2d& place) const;
    double reach() const { return 0.8 * text; }
};

} // namespace osgGeoFX
