// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/Export.h>
#include <osgGeoFX/lines/LineStyle.h>
#include <osgGeoFX/lines/MapLine.h>

#include <osg/Group>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace osgGeoFX
{

/** The lines of a map in a scene: roads, lifts, rivers, borders.

    Make it a child of the EffectScene, beside the terrain. Then the GPU moves lines as it moves the ground: through bends, in panorama maps and
    in close-ups. Their widths are pixels of the picture, by the distance. What lies before a line hides it. Lines write no depth, so they
    hide nothing, and neither picking nor DepthReader meets them. In a panorama map they keep their colors.

    A line is a strip before the eye with the depth of its middle, but of level ground where that is nearer, so that no side of a wide line is hidden.
    The terrain's triangles may be coarser than the line, so lines are drawn nearer by a small share of their distance (`setNearer`), and one
    close behind a ridge shows through.

    Programs of the kit, so it draws in compatibility and in core profiles. LinePicture gives the same lines as vectors.

    Threads: make and change it between frames. Files do not keep it.
    @ingroup lines */
class OSGGEOFXMAPS_EXPORT MapLines : public osg::Group
{
public:
    /// `lines`: placed ones (LinePlacement); world coordinates of the scene's children, metres.
    MapLines(std::vector<MapLine> lines, std::map<std::string, LineStyle> styles);
    const char* libraryName() const override { return "osgGeoFX"; }
    const char* className() const override { return "MapLines"; }

    /// What it was made of.
    const std::vector<MapLine>& lines() const { return _lines; }
    const std::map<std::string, LineStyle>& styles() const { return _styles; }

    /// Whether lines are drawn. True by default.
    void setShown(bool shown) { _shown = shown; }
    bool isShown() const { return _shown; }

    /// The factor of all widths, such as that of a print's resolution; > 0. 1 is for pictures 900 pixels high.
    void setScale(double scale);
    double getScale() const { return _scale; }
    /// The share of its distance by which a line is nearer than its place, 0…0.1; 0.006 by default.
    void setNearer(double share);
    double getNearer() const { return _nearer; }

    void traverse(osg::NodeVisitor& visitor) override;
    void resizeGLObjectBuffers(unsigned int size) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~MapLines() override;

private:
    struct Drawing;
    void describe();

    const std::vector<MapLine> _lines;
    const std::map<std::string, LineStyle> _styles;
    bool _shown = true;
    double _scale = 1.0;
    double _nearer = 0.006;
    std::unique_ptr<Drawing> _drawing;
};

} // namespace osgGeoFX
