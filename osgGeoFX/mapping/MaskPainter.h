// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/mapping/ProjectiveMappings.h>

#include <osgGA/GUIEventHandler>

#include <optional>
#include <vector>

namespace osgGeoFX
{

class EffectScene;

/** Paints soft round strokes into a mask on the terrain (Trapp and Döllner 2009, Section 5: masks drawn by the user).

    The mask lies at the place of the given mapping, in its raster coordinates. It is grey, 0…255. A stroke is a line
    with a soft edge along all its places. It is not stronger where it crosses itself. undo() removes a whole stroke.
    Only the texels under the brush are computed, and each place of a stroke uploads the mask's image once.

    Places are in the mappings' frame, metres. The thread of the frame loop calls the functions, between frames.
    @ingroup mapping */
class OSGGEOFX_EXPORT MaskPainter : public osg::Referenced
{
public:
    /// Gives the mapping a new, empty mask of this size, texels (limited to 1…16384), and sets its transfer's alpha to
    /// FROM_MASK.
    MaskPainter(ProjectiveMapping& mapping, int width, int height);

    struct Brush
    {
        double radius = 100.0; ///< metres, 0.001…1e7
        double hardness = 0.5; ///< 0…1: the share of the radius that has the full strength
        double strength = 1.0; ///< 0…1
        bool erase = false;
    };
    /// Returns false and keeps the former brush, with a warning, if a value is out of range.
    bool setBrush(const Brush& brush);
    const Brush& getBrush() const { return _brush; }

    /// A stroke begins at one place, runs through any number of further places, and ends with end().
    void begin(const osg::Vec2d& place);
    void moveTo(const osg::Vec2d& place);
    void end();
    bool painting() const { return _last.has_value(); }

    /// Removes the last stroke. Returns false if there is none.
    bool undo();
    /// Whether undo() has a stroke to remove.
    bool canUndo() const { return !_strokes.empty(); }
    /// The largest number of strokes that undo() can remove. Default: 50.
    void setHistory(std::size_t strokes);
    /// Fills the whole mask with one grey, 0…1. undo() can remove this, too.
    void fill(double grey);

    osg::Image& image() const { return *_image; }
    ProjectiveMapping& mapping() const { return *_mapping; }
    /// The mask's value at a place, 0…1. It is 0 outside the mask.
    double at(const osg::Vec2d& place) const;

protected:
    ~MaskPainter() override;

private:
    /// A rectangle of texels, the upper ends excluded.
    struct Area
    {
        int left = 0, bottom = 0, right = 0, top = 0;
        bool empty() const { return right <= left || top <= bottom; }
    };
    struct Stroke
    {
        Area area;
        std::vector<unsigned char> before; ///< the mask's texels in the area
    };
    void draw(const osg::Vec2d& from, const osg::Vec2d& to);
    Area areaAround(const osg::Vec2d& from, const osg::Vec2d& to) const;
    Area whole() const;
    void keep(Stroke stroke);

    osg::ref_ptr<ProjectiveMapping> _mapping;
    osg::ref_ptr<osg::Image> _image;
    Brush _brush;
    std::optional<osg::Vec2d> _last;
    std::vector<unsigned char> _before; ///< the mask as it was when the stroke began
    std::vector<float> _cover;          ///< of the stroke, 0…1
    Area _touched;
    std::vector<Stroke> _strokes;
    std::size_t _history = 50;
};

/** An event handler that paints a mask with the mouse. Shift and the left button paint. Ctrl, Shift and the left
    button erase. Shift and the mouse wheel change the brush's size. Ctrl and Z remove the last stroke. The strokes lie
    on the ground as the effects deform it. One handler serves one view.
    @ingroup mapping */
class OSGGEOFX_EXPORT MaskPaintHandler : public osgGA::GUIEventHandler
{
public:
    /// `mappings` hosts the painter's mapping and must be an effect of `scene`.
    MaskPaintHandler(EffectScene& scene, ProjectiveMappings& mappings, MaskPainter& painter);

    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& action) override;
    void getUsage(osg::ApplicationUsage& usage) const override;

protected:
    ~MaskPaintHandler() override;

private:
    osg::ref_ptr<EffectScene> _scene;
    osg::ref_ptr<ProjectiveMappings> _mappings;
    osg::ref_ptr<MaskPainter> _painter;
};

} // namespace osgGeoFX
