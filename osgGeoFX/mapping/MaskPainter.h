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

    The mask lies where the given mapping does, in its raster coordinates; it is grey, 0…255. A stroke is a line with a soft
    edge along all of its places, no stronger where it crosses itself, and one step for undo(). Only what is under the brush is
    computed, and the mask's image is dirtied once for each place.

    Places are those of the mappings' frame, metres. By the thread of the frame loop, between frames. */
class OSGGEOFX_EXPORT MaskPainter : public osg::Referenced
{
public:
    /// Gives the mapping a new, empty mask of this size, texels, and alpha FROM_MASK.
    MaskPainter(ProjectiveMapping& mapping, int width, int height);

    struct Brush
    {
        double radius = 100.0; ///< metres
        double hardness = 0.5; ///< 0…1: the share of the radius that is at full strength
        double strength = 1.0; ///< 0…1
        bool erase = false;
    };
    /// Refused where out of range.
    bool setBrush(const Brush& brush);
    const Brush& getBrush() const { return _brush; }

    /// A stroke: from a first place, along any number more.
    void begin(const osg::Vec2d& place);
    void moveTo(const osg::Vec2d& place);
    void end();
    bool painting() const { return _last.has_value(); }

    /// Takes the last stroke back; false where there is none.
    bool undo();
    /// Whether there is something to take back.
    bool canUndo() const { return !_strokes.empty(); }
    /// Strokes that are kept for undo(), at most; 50 by default.
    void setHistory(std::size_t strokes);
    /// All to one grey, 0…1; a step for undo().
    void fill(double grey);

    osg::Image& image() const { return *_image; }
    ProjectiveMapping& mapping() const { return *_mapping; }
    /// The mask at a place, 0…1; 0 outside.
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

/** Paints with the mouse: Shift and the left button paint, with Ctrl as well they erase; Shift and the wheel change the brush'
    size, Ctrl and Z take a stroke back. On the ground as the effects show it. Serves one view. */
class OSGGEOFX_EXPORT MaskPaintHandler : public osgGA::GUIEventHandler
{
public:
    /// The mappings must be an effect of the scene.
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
