// SPDX-License-Identifier: MIT
// SPDX-FileCopyrightText: 2026 the osgGeoFX authors
#pragma once

#include <osgGeoFX/effect/PropertyHolder.h>

#include <vector>

namespace osgGeoFX
{

/** The fence between a region on the ground and its close-up, in the close-up's color (paper: interactive close-ups,
    Section II.D).

    A table gives its opacity at each normalised height: 0 at the ground, 1 at the close-up. The thread of the frame
    loop changes an anchor, between frames. Reading is thread-safe. Setters refuse values out of range: they return
    false, warn once and keep the former value.
    @ingroup closeup */
class OSGGEOFX_EXPORT Anchor : public PropertyHolder
{
public:
    Anchor();
    Anchor(const Anchor& other, const osg::CopyOp& copy = osg::CopyOp::SHALLOW_COPY);
    META_Object(osgGeoFX, Anchor);

    enum Kind
    {
        NONE,
        STRETCHED, ///< the terrain's triangles, stretched up to the close-up (the paper); needs many vertices
        CONTOUR    ///< a wall along the region's border; needs no vertices of the terrain
    };
    /// Default: CONTOUR.
    bool setKind(Kind kind) { return assign("kind", kind); }
    Kind getKind() const { return static_cast<Kind>(_kind); }

    /// The ready tables of opacities: those of the paper's Figure 4 and more.
    enum Style
    {
        SOLID,   ///< opaque everywhere
        VEIL,    ///< an opacity of 0.35 everywhere
        RISING,  ///< transparent at the ground, opaque at the close-up
        FALLING, ///< opaque at the ground, transparent at the close-up
        ENDS,    ///< opaque at both ends, transparent between them
        MIDDLE,  ///< transparent at both ends, opaque between them
        RINGS,   ///< eight bands
        TABLE    ///< the table of setTable()
    };
    /// Default: FALLING.
    bool setStyle(Style style) { return assign("style", style); }
    Style getStyle() const { return static_cast<Style>(_style); }
    /// Opacities at equal steps from the ground to the close-up, 2…256 values of 0…1. The setter sets the style to
    /// TABLE.
    bool setTable(const std::vector<float>& opacities);
    const std::vector<float>& getTable() const { return _table; }

    /// The opacity of the whole anchor, 0…1. Default: 0.8.
    bool setOpacity(double opacity) { return assign("opacity", opacity); }
    double getOpacity() const { return _opacity; }
    /// The width of the lines around the region on the ground and around the close-up, pixels, 0…64. 0 means no lines.
    /// Default: 2.
    bool setLineWidth(double pixels) { return assign("lineWidth", pixels); }
    double getLineWidth() const { return _lineWidth; }

    /// The opacity at a normalised height of 0…1, times the anchor's `opacity`. It is linear between the table's
    /// values.
    double opacityAt(double height) const;

    const Properties& properties() const override;

protected:
    ~Anchor() override;

private:
    int _kind = CONTOUR;
    int _style = FALLING;
    double _opacity = 0.8, _lineWidth = 2.0;
    std::vector<float> _table = {1.0f, 0.0f};
};

} // namespace osgGeoFX
