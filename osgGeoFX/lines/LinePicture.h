// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/lines/LineStyle.h>
#include <osgGeoFX/lines/MapLine.h>
#include <osgGeoFX/scene/DepthReader.h>
#include <osgGeoFX/scene/EffectScene.h>

#include <osg/Camera>
#include <osg/Image>
#include <osg/Vec2d>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

struct _cairo; // cairo_t of Cairo

namespace osgGeoFX
{

/** The lines of one finished picture as vectors, for programs that write SVG, PDF or GeoJSON. Live pictures have MapLines, whose lines lie
    at the same pixels.

    A part of a line is what is to be seen of it, between places where something hides it. Gaps of a few pixels are closed, for terrain that is
    drawn more coarsely than the line hides it in places.
    @ingroup lines */
class OSGGEOFXMAPS_EXPORT LinePicture
{
public:
    struct Part
    {
        std::size_t line = 0;           ///< its index in lines()
        std::vector<osg::Vec2d> points; ///< pixels, y upwards
        std::vector<double> along;      ///< of each point, metres from the line's beginning
        std::vector<double> perMetre;   ///< of each point, pixels for each metre at its distance
    };

    /** `lines`: placed ones (LinePlacement). `camera`: of the whole picture, with its viewport. `depths`: of the frame, from the cameras that drew
        the picture or its parts (DepthReader::pictures()), which hide lines; empty: nothing counts as hidden. They may be those of
        a smaller picture of the same view. `scale`: the factor of all widths, as MapLines::setScale(). */
    LinePicture(std::vector<MapLine> lines, std::map<std::string, LineStyle> styles, EffectScene& scene,
                const osg::Camera& camera, const std::vector<std::shared_ptr<const DepthPicture>>& depths,
                double scale = 1.0);

    /// The same lines in a picture of the same view that is so many times larger, with widths that are, too.
    LinePicture enlarged(double factor) const;

    const std::vector<MapLine>& lines() const { return _lines; }
    /// By rising rank of their styles.
    const std::vector<Part>& parts() const { return _parts; }
    const LineStyle& styleOf(const Part& part) const { return lineStyleOf(_styles, _lines[part.line].style); }
    double width() const { return _width; }
    double height() const { return _height; }
    double scale() const { return _scale; }

    /// A piece of a part that has one width, as pens draw it.
    struct Piece
    {
        std::vector<osg::Vec2d> points; ///< pixels, y upwards
        double width = 0.0;             ///< pixels
        double dash = 0.0, gap = 0.0;   ///< pixels; 0: none
        double offset = 0.0;            ///< the place in dash and gap at which the piece begins, pixels
    };
    std::vector<Piece> piecesOf(const Part& part) const;

    /// Draws outlines and lines to Cairo, in the picture's pixels with y downwards.
    void draw(_cairo* target) const;
    /// Draws them onto some rows of the picture, as LabelPicture::drawOnto() does.
    bool drawOnto(osg::Image& rows, int top = 0) const;

private:
    std::vector<MapLine> _lines;
    std::map<std::string, LineStyle> _styles;
    std::vector<Part> _parts;
    double _width;
    double _height;
    double _scale;
};

} // namespace osgGeoFX
